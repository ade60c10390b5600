// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// cord_weight: a cord is heavier than set.
///   m  how much more, g/m
///
///   w += m                                                                                  (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::cord_weight_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "more_g_per_m",
    .symbol = "m",
    .meaning = "how much heavier a metre of it is",
    .nominal = 8.0,
    .lower = 0.0,
    .upper = 200.0,
    .prior_sigma = 8.0,
}};

// (1)
constexpr double kNewtonPerMmOfGramPerM = 9.80665e-6;

void alter(Statics& m, EffectSide side, const CordVisit& /*visit*/, Values values) {
  for (const Side own : kSides)
    if (acts_on(side, own)) m.cord[own].weight_n_per_mm += values[0] * kNewtonPerMmOfGramPerM;
}

}  // namespace

extern constinit const PlotterEffect cord_weight{
    .described =
        {
            .id = "cord_weight",
            .station = effects::Station::machine,
            .sides = effects::kAnyChain,
            .parameters = kParameters,
            .cause = "a cord, chain or belt weighs more than set and sags",
            .signature = "horizontals hang through at the sides, where one cord is long and slack",
            .equation = "catenary of w + m",
            .source = "elastic catenary (Irvine)",
            .not_modelled = "a cable that is tied to a cord in places",
            .typical = "5 to 10 g/m",
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy =
                "weigh a length of it and enter it, or use a lighter cord or a heavier gondola",
        },
    .alter = alter,
};

}  // namespace chaintrue::model::plotter::cord_weight_effect
