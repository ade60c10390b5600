// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sprocket_eccentricity: a sprocket turns about a point that is not its centre.
///   a  amplitude [mm]
///   p  phase [rad]
///   u  chain of one turn, teeth * pitch [mm]
///
///   added  = a sin(2 pi L0 / u + p)                                                         (1)
#include <numbers>

#include "model/effects/notation.hpp"

namespace chaintrue::model::effects {

extern constinit const Effect sprocket_eccentricity{
    .id = "sprocket_eccentricity",
    .station = Station::chain,
    .sides = kOneChain,
    .parameters = {size("amplitude_mm", "a",
                        "how far the sprocket's centre is from its axis of rotation", 0.3, 0.0, 5.0),
                   place("phase_rad", "p", "where in its turn the sprocket stands at length 0", 0.0,
                         -2.0 * std::numbers::pi, 2.0 * std::numbers::pi, std::numbers::pi)},
    .cause = "a sprocket is bored off its centre or its shaft is bent",
    .signature = "a wave along one chain that repeats with every turn of its sprocket (63.5 mm)",
    .equation = "+ a sin(2 pi L0 / (teeth pitch) + p)",
    .source = "run-out of a wheel on its axis, first harmonic",
    .not_modelled = "the second harmonic of the tangent point, below a^2 / r",
    .typical = "0.1 to 0.5 mm",
    .remedy_kind = RemedyKind::compensate_on_its_own,
    .remedy =
        "change the sprocket, or cut with a map that has it for a cause: a wave over the chain's "
        "length is shorter than marks over x and y can show",
    .add =
        [](const LengthState& chain, Values v) -> Number {
          return v[0] * sin(2.0 * std::numbers::pi / chain.turn_mm * chain.length_mm + v[1]);
        },
};

}  // namespace chaintrue::model::effects
