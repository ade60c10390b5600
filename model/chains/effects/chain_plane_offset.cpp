// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chain_plane_offset: the chains do not run in the plane of the sled's pins.
///   S  free chain [mm]
///   z  distance of the planes [mm]
///
///   added = sqrt(S^2 + z^2) - S = z^2 / (sqrt(S^2 + z^2) + S)                               (1)
#include "model/effects/notation.hpp"

namespace chaintrue::model::effects {

extern constinit const Effect chain_plane_offset{
    .id = "chain_plane_offset",
    .station = Station::chain,
    .parameters = {size("distance_mm", "z",
                        "distance between the planes of the sprockets and of the chains' ends at "
                        "the sled",
                        30.0, 0.0, 300.0)},
    .cause = "the sprockets are farther from the sheet than the chains' ends at the sled",
    .signature = "a few tenths of a millimetre more chain near the upper corners",
    .equation = "+ sqrt(S^2 + z^2) - S, both chains",
    .source = "Pythagoras; MaslowCNC forum",
    .not_modelled = "forces, which remain those of the flat machine",
    .typical = "20 to 40 mm",
    .remedy = "level the chains with the sheet (spacers under the motors), or enter the distance",
    .add = [](const LengthState& chain, Values v) -> Number {
      const double z = v[0];
      if (z == 0.0) return {};
      return z * z / (sqrt(chain.free_mm * chain.free_mm + z * z) + chain.free_mm);
    },
};

}  // namespace chaintrue::model::effects
