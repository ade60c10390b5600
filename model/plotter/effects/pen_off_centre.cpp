// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// pen_off_centre: the pen is not in the middle of the gondola.
///   o  how far to the right of where it is set, mm
///
///   pen_right += o                                                                          (1)
///
/// A gondola that hangs level shifts the whole drawing; one that tilts turns the offset with it.
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::pen_off_centre_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "o",
    .meaning = "how far the pen is right of its setting",
    .nominal = 5.0,
    .lower = -200.0,
    .upper = 200.0,
    .prior_sigma = 5.0,
    .mirror_sign = -1.0,
}};

// (1)
void alter(Statics& m, EffectSide /*side*/, const CordVisit& /*visit*/, Values values) {
  m.pen_right_mm += values[0];
}

}  // namespace

extern constinit const PlotterEffect pen_off_centre{
    .described =
        {
            .id = "pen_off_centre",
            .station = effects::Station::machine,
            .sides = effects::kNoSide,
            .parameters = kParameters,
            .cause = "the pen does not sit in the middle of the gondola",
            .signature = "verticals lean and horizontals bow where the gondola tilts: most near "
                         "the sides, in opposite directions left and right",
            .equation = "pen_right + o",
            .source = "a point of a rigid body turns with it",
            .not_modelled = "a pen that wobbles in its holder",
            .typical = "1 to 10 mm",
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy = "put the pen into the middle between the cords, or enter its offset",
        },
    .alter = alter,
    .needs = needs_body,
};

}  // namespace chaintrue::model::plotter::pen_off_centre_effect
