// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// gondola_mass: the gondola is heavier or lighter than set.
///   g  mass over set, less 1
///
///   W (1 + g)                                                                               (1)
///
/// It shows through what the weight does: cords that stretch, and cords that sag under a light gondola.
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::gondola_mass_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "relative",
    .symbol = "g",
    .meaning = "how much heavier it is than set, as a share",
    .nominal = -0.4,
    .lower = -0.9,
    .upper = 9.0,
    .prior_sigma = 0.4,
}};

// (1)
void alter(Statics& m, EffectSide /*side*/, const CordVisit& /*visit*/, Values values) {
  m.weight_n *= 1.0 + values[0];
}

}  // namespace

extern constinit const PlotterEffect gondola_mass{
    .described =
        {
            .id = "gondola_mass",
            .station = effects::Station::machine,
            .sides = effects::kNoSide,
            .parameters = kParameters,
            .cause = "the gondola is too light to keep its cords straight, or heavier than set",
            .signature = "with heavy cords the long ones sag: horizontals bow at the sides; with "
                         "cords that stretch the drawing is taller at the bottom",
            .equation = "W (1 + g)",
            .source = "elastic catenary",
            .not_modelled = "cords that keep the curl of their spool",
            .typical = "20 to 50 %",
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy = "weigh the gondola and enter it; add weight until the cords hang straight",
        },
    .alter = alter,
};

}  // namespace chaintrue::model::plotter::gondola_mass_effect
