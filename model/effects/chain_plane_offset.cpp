// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chain_plane_offset: the chains run in another plane than the sled's pins.
///   S  free chain [mm]
///   z  distance of the planes [mm]
///
///   added = sqrt(S^2 + z^2) - S = z^2 / (sqrt(S^2 + z^2) + S)                               (1)
///   d/dS  = S / sqrt(S^2 + z^2) - 1 = -added / sqrt(S^2 + z^2)                              (2)
#include <cmath>

#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::chain_plane_offset_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "distance_mm",
    .symbol = "z",
    .meaning =
        "distance between the plane of the sprockets and that of the chains' ends at the sled",
    .nominal = 30.0,
    .lower = 0.0,
    .upper = 300.0,
    .prior_sigma = 30.0,
}};

ChainAddition add(const ChainAtRest& chain, Values values) {
  const double free = chain.state.free_length_mm;
  const double z = values[0];
  if (z == 0.0) return {};
  const double slant = std::hypot(free, z);
  const double added = z * z / (slant + free);  // (1), without cancellation
  return {.length_mm = added, .per_free_length = -added / slant};
}

}  // namespace

extern constinit const Effect chain_plane_offset{
    .id = "chain_plane_offset",
    .station = Station::chain,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause = "the sprockets stand further from the sheet than the chains' ends at the sled",
    .signature =
        "a few tenths of a millimetre more chain where it is short, near the upper corners",
    .equation = "+ sqrt(S^2 + z^2) - S, both chains",
    .source = "Pythagoras; MaslowCNC forum, List of sources of error",
    .not_modelled =
        "sled and chain leaving the plane they hang in: forces stay those of the flat machine",
    .typical = "20 to 40 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "level the chains with the sheet (spacers under the motors), or enter the distance",
    .add = add,
};

}  // namespace chaintrue::model::effects::chain_plane_offset_effect
