// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// gondola_width: the points where the cords hold the gondola are farther apart than set.
///   w  how much, mm
///
///   spacing += w                                                                            (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::gondola_width_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "w",
    .meaning = "how much farther apart they are than set",
    .nominal = 2.0,
    .lower = -50.0,
    .upper = 50.0,
    .prior_sigma = 2.0,
}};

// (1)
void alter(Statics& m, EffectSide /*side*/, const CordVisit& /*visit*/, Values values) {
  m.spacing_mm += values[0];
}

}  // namespace

extern constinit const PlotterEffect gondola_width{
    .described =
        {
            .id = "gondola_width",
            .station = effects::Station::machine,
            .sides = effects::kNoSide,
            .parameters = kParameters,
            .cause = "the gondola's pulleys or eyelets are farther apart than set",
            .signature = "as a change of the spacing of the pins, less what the tilt makes of it",
            .equation = "spacing + w",
            .source = "statics of a body on two cords",
            .not_modelled = "pulleys at different heights in the gondola",
            .typical = "1 to 3 mm",
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy = "measure between the axles of the pulleys and enter it",
        },
    .alter = alter,
    .needs = needs_body,
};

}  // namespace chaintrue::model::plotter::gondola_width_effect
