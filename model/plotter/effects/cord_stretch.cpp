// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// cord_stretch: a cord stretches more than set.
///   c  compliance over set, per N
///
///   compliance += c                                                                         (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::cord_stretch_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "compliance_per_n",
    .symbol = "c",
    .meaning = "how much more it stretches per newton, as a share of its length",
    .nominal = 2e-4,
    .lower = 0.0,
    .upper = 0.01,
    .prior_sigma = 2e-4,
}};

// (1)
void alter(Statics& m, EffectSide side, const CordVisit& /*visit*/, Values values) {
  for (const Side own : kSides)
    if (acts_on(side, own)) m.cord[own].compliance_per_n += values[0];
}

}  // namespace

extern constinit const PlotterEffect cord_stretch{
    .described =
        {
            .id = "cord_stretch",
            .station = effects::Station::machine,
            .sides = effects::kAnyChain,
            .parameters = kParameters,
            .cause = "cords or belts stretch under the gondola more than set",
            .signature = "the pen hangs low where its cords are long and where they pull hard: "
                         "horizontals bow at the top of the drawing, and its bottom is low",
            .equation = "S (1 + (compliance + c) T)",
            .source = "Hooke; nikivanov/mural sets 5e-5 per N",
            .not_modelled = "creep",
            .typical = "1e-4 to 5e-4 per N",
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy = "use belts with glass fibre, or enter how much they stretch",
        },
    .alter = alter,
};

}  // namespace chaintrue::model::plotter::cord_stretch_effect
