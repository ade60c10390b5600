// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// spool_eccentricity: a pulley or spool turns about a point that is not its centre.
///   a  amplitude, mm
///   p  phase, rad
///   u  cord of one turn, mm
///
///   added = a sin(2 pi L / u + p)                                                           (1)
#include <numbers>

#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::spool_eccentricity_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
                                               .name = "amplitude_mm",
                                               .symbol = "a",
                                               .meaning = "how far its centre is from its axis",
                                               .nominal = 0.2,
                                               .lower = 0.0,
                                               .upper = 10.0,
                                               .prior_sigma = 0.2,
                                           },
                                           {
                                               .name = "phase_rad",
                                               .symbol = "p",
                                               .meaning = "where in its turn it stands at length 0",
                                               .role = effects::ParameterRole::place,
                                               .nominal = 0.0,
                                               .lower = -6.3,
                                               .upper = 6.3,
                                               .prior_sigma = 3.2,
                                           }};

// (1)
Number add(const CordState<Number>& cord, const CordVisit& visit, Values values) {
  return values[0] * sin(2.0 * std::numbers::pi / visit.turn_mm * cord.length_mm + values[1]);
}

}  // namespace

extern constinit const PlotterEffect spool_eccentricity{
    .described =
        {
            .id = "spool_eccentricity",
            .station = effects::Station::chain,
            .sides = effects::kOneChain,
            .parameters = kParameters,
            .cause = "a pulley or spool is bored off its centre, or its shaft is bent",
            .signature = "a wave along every line that repeats with each turn of one pulley",
            .equation = "+ a sin(2 pi L / u + p)",
            .source = "run-out of a wheel on its axis, first harmonic",
            .not_modelled = "the second harmonic, below a^2 / r",
            .typical = "0.1 to 0.5 mm",
            .remedy_kind = effects::RemedyKind::repair,
            .remedy = "change the pulley: no setting holds it",
        },
    .add = add,
    .needs = needs_pulley,
};

}  // namespace chaintrue::model::plotter::spool_eccentricity_effect
