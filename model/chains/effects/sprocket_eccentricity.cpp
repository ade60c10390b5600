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
    .parameters = {size("amplitude_mm", "a", "distance of the sprocket's centre from its axis", 0.3,
                        0.0, 5.0),
                   place("phase_rad", "p", "phase at length 0", 0.0, -2.0 * std::numbers::pi,
                         2.0 * std::numbers::pi, std::numbers::pi)},
    .cause = "a sprocket is bored off its centre or its shaft is bent",
    .signature = "a wave along one chain that repeats with every turn of its sprocket (63.5 mm)",
    .equation = "+ a sin(2 pi L0 / (teeth pitch) + p)",
    .source = "run-out of a wheel, first harmonic",
    .not_modelled = "the second harmonic of the tangent point, below a^2 / r",
    .typical = "0.1 to 0.5 mm",
    .remedy_kind = RemedyKind::compensate_on_its_own,
    .remedy =
        "replace the sprocket, or cut with a map that includes this cause; marks alone cannot "
        "resolve so short a wave",
    .add = [](const LengthState& chain, Values v) -> Number {
      return v[0] * sin(2.0 * std::numbers::pi / chain.turn_mm * chain.length_mm + v[1]);
    },
};

}  // namespace chaintrue::model::effects
