// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// angular_kink: beyond an angle the chain does not leave the sprocket along its tangent.
///   phi  chain's angle below the horizontal [rad]
///   k    slope [mm/rad]
///   m    knee [rad]
///
///   added = k max(0, phi - m)                                                               (1)
#include <numbers>

#include "model/effects/notation.hpp"

namespace chaintrue::model::effects {

extern constinit const Effect angular_kink{
    .id = "angular_kink",
    .station = Station::chain,
    .sides = kOneChain,
    .parameters = {size("slope_mm_per_rad", "k", "chain per radian beyond the knee", 4.5, -60.0,
                        60.0),
                   place("knee_rad", "m", "angle below the horizontal where it sets in", 0.9,
                         -std::numbers::pi / 2.0, std::numbers::pi / 2.0, 0.3)},
    .cause = "a guard, a bracket or a cut sprocket touches the chain beyond some angle",
    .signature = "an error of one chain that grows below a line through its motor",
    .equation = "+ k max(0, phi - m)",
    .source = "FirePick Delta, Sliced Pulley Error: linear beyond a critical angle",
    .not_modelled = "a rounded knee, friction at the guard",
    .typical = "3 to 6 mm/rad",
    .remedy_kind = RemedyKind::repair,
    .remedy = "find what the chain touches below that angle and clear it",
    .add = [](const LengthState& chain, Values v) -> Number {
      return v[0] * max(chain.angle_rad - v[1], Number(0.0));
    },
};

}  // namespace chaintrue::model::effects
