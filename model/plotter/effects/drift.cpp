// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// drift: a cord's count drifts from visit to visit.
///   d  rate, mm per visit
///
///   added = d n                                                                             (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::drift_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "rate_mm_per_visit",
    .symbol = "d",
    .meaning = "what is counted too much with each visit",
    .nominal = 0.03,
    .lower = -1.0,
    .upper = 1.0,
    .prior_sigma = 0.03,
}};

// (1)
Number add(const CordState<Number>& /*cord*/, const CordVisit& visit, Values values) {
  return values[0] * visit.order;
}

}  // namespace

extern constinit const PlotterEffect drift{
    .described =
        {
            .id = "drift",
            .station = effects::Station::chain,
            .sides = effects::kAnyChain,
            .parameters = kParameters,
            .cause = "a cord crept, or slips a little with each move",
            .signature = "the last lines do not meet the first",
            .equation = "+ d n",
            .source = "cords of plastic creep under load",
            .not_modelled = "a drift that levels off",
            .typical = "0.01 to 0.05 mm a visit",
            .needs = effects::DataNeed::order,
            .remedy_kind = effects::RemedyKind::repair,
            .remedy = "let the gondola hang an hour before drawing; use belts with glass fibre",
        },
    .add = add,
};

}  // namespace chaintrue::model::plotter::drift_effect
