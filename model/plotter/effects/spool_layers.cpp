// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// spool_layers: a spool grows with the cord on it, so that a turn pays out more of a short cord than of a long one.
///   b  growth: how much a metre of cord that is out takes from a metre that follows, mm per m^2
///   L  the cord, m
///
///   added = b L^2 / 2                                                                       (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::spool_layers_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "growth_mm_per_m2",
    .symbol = "b",
    .meaning = "how much more is counted for the second metre than for the first",
    .nominal = 5.0,
    .lower = 0.0,
    .upper = 500.0,
    .prior_sigma = 5.0,
}};

// (1)
constexpr double kMPerMm = 1e-3;

Number add(const CordState<Number>& cord, const CordVisit& /*visit*/, Values values) {
  const Number metres = kMPerMm * cord.length_mm;
  return 0.5 * values[0] * metres * metres;
}

}  // namespace

extern constinit const PlotterEffect spool_layers{
    .described =
        {
            .id = "spool_layers",
            .station = effects::Station::chain,
            .sides = effects::kAnyChain,
            .parameters = kParameters,
            .cause = "the cord winds in layers on its spool, whose diameter shrinks as it pays out",
            .signature = "the drawing shrinks to the bottom, and verticals lean towards the spool",
            .equation = "+ b L^2 / 2",
            .source = "length on a spool of Archimedes; RepRapFirmware HangprinterKinematics.cpp "
                      "takes the same as a root of L",
            .not_modelled = "the step from one layer to the next",
            .typical = "2 to 20 mm/m^2",
            .remedy_kind = effects::RemedyKind::repair,
            .remedy = "wind the cord side by side in one layer, or use a toothed belt on a pulley",
        },
    .add = add,
};

}  // namespace chaintrue::model::plotter::spool_layers_effect
