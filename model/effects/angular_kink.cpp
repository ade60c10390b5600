// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// angular_kink: beyond an angle the chain does not leave the sprocket along its tangent.
///   phi  chain's angle below the horizontal [rad]
///   k    slope [mm/rad]
///   m    knee [rad]
///
///   added = k max(0, phi - m)                                                               (1)
#include <numbers>

#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::angular_kink_effect {
namespace {

constexpr EffectParameter kParameters[] = {
    {
        .name = "slope_mm_per_rad",
        .symbol = "k",
        .meaning = "chain added per radian beyond the knee",
        .nominal = 4.5,
        .lower = -60.0,
        .upper = 60.0,
        .prior_sigma = 4.5,
    },
    {
        .name = "knee_rad",
        .symbol = "m",
        .meaning = "the angle below the horizontal at which it sets in",
        .role = ParameterRole::place,
        .null = 0.9,
        .nominal = 0.9,
        .lower = -std::numbers::pi / 2.0,
        .upper = std::numbers::pi / 2.0,
        .prior_sigma = 0.3,
    },
};

// (1)
ChainAddition add(const ChainAtRest& chain, Values values) {
  const double beyond = chain.state.angle_rad - values[1];
  if (beyond <= 0.0) return {};
  return {.length_mm = values[0] * beyond, .per_angle_mm_per_rad = values[0]};
}

}  // namespace

extern constinit const Effect angular_kink{
    .id = "angular_kink",
    .station = Station::chain,
    .sides = kOneChain,
    .parameters = kParameters,
    .cause =
        "a guard, a bracket or a cut pulley touches the chain once it hangs steeper than some "
        "angle",
    .signature =
        "nothing up to a line through the motor, then an error that grows below it, on that side's "
        "chain",
    .equation = "+ k max(0, phi - m)",
    .source = "FirePick Delta, Sliced Pulley Error: linear beyond a critical angle",
    .not_modelled = "the rounding of the knee, and friction at the guard",
    .typical = "3 to 6 mm/rad",
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "look for what the chain touches below that angle (guard, bracket, cut sprocket) and clear "
        "it",
    .add = add,
};

}  // namespace chaintrue::model::effects::angular_kink_effect
