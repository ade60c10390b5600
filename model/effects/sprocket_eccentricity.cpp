// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sprocket_eccentricity: a sprocket turns about a point that is not its centre.
///   a  amplitude [mm]
///   p  phase [rad]
///   u  chain of one turn, teeth * pitch [mm]
///
///   added  = a sin(2 pi L0 / u + p)                                                         (1)
///   d/dL0  = a (2 pi / u) cos(2 pi L0 / u + p)                                              (2)
#include <cmath>
#include <numbers>

#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::sprocket_eccentricity_effect {
namespace {

constexpr EffectParameter kParameters[] = {
    {
        .name = "amplitude_mm",
        .symbol = "a",
        .meaning = "how far the sprocket's centre is from its axis of rotation",
        .nominal = 0.3,
        .lower = 0.0,
        .upper = 5.0,
        .prior_sigma = 0.3,
    },
    {
        .name = "phase_rad",
        .symbol = "p",
        .meaning = "where in its turn the sprocket stands at length 0",
        .role = ParameterRole::place,
        .lower = -2.0 * std::numbers::pi,
        .upper = 2.0 * std::numbers::pi,
        .prior_sigma = std::numbers::pi,
    },
};

ChainAddition add(const ChainAtRest& chain, Values values) {
  const double per_mm = 2.0 * std::numbers::pi / chain.turn_mm;
  const double turn = per_mm * chain.length_mm + values[1];
  return {.length_mm = values[0] * std::sin(turn),             // (1)
          .per_length = values[0] * per_mm * std::cos(turn)};  // (2)
}

}  // namespace

extern constinit const Effect sprocket_eccentricity{
    .id = "sprocket_eccentricity",
    .station = Station::chain,
    .sides = kOneChain,
    .parameters = kParameters,
    .cause = "a sprocket is bored off its centre or its shaft is bent",
    .signature = "a wave along one chain that repeats with every turn of its sprocket (63.5 mm)",
    .equation = "+ a sin(2 pi L0 / (teeth pitch) + p)",
    .source = "run-out of a wheel on its axis, first harmonic",
    .not_modelled = "the second harmonic of the tangent point, below a^2 / r",
    .typical = "0.1 to 0.5 mm",
    .remedy_kind = RemedyKind::compensate_on_its_own,
    .remedy =
        "change the sprocket, or cut with a map that has it for a cause: a wave over the chain's length is "
        "shorter than marks over x and y can show",
    .add = add,
};

}  // namespace chaintrue::model::effects::sprocket_eccentricity_effect
