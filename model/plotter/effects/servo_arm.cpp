// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// servo_arm: the gondola's mass is off its middle: the arm of the pen's servo, a battery.
///   o  how far to the right of where it is set, mm
///
///   mass_right += o                                                                         (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::servo_arm_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "o",
    .meaning = "how far the centre of mass is right of its setting",
    .nominal = 4.0,
    .lower = -200.0,
    .upper = 200.0,
    .prior_sigma = 4.0,
    .mirror_sign = -1.0,
}};

// (1)
void alter(Statics& m, EffectSide /*side*/, const CordVisit& /*visit*/, Values values) {
  m.mass_right_mm += values[0];
}

}  // namespace

extern constinit const PlotterEffect servo_arm{
    .described =
        {
            .id = "servo_arm",
            .station = effects::Station::machine,
            .sides = effects::kNoSide,
            .parameters = kParameters,
            .cause = "the servo's arm, a battery or a cable holds the gondola's mass to one side",
            .signature = "the gondola hangs askew in the middle of the wall, and the drawing leans "
                         "to one side",
            .equation = "mass_right + o",
            .source = "moments about the middle between the cords",
            .not_modelled = "an arm that moves the mass while it draws",
            .typical = "1 to 10 mm",
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy = "balance the gondola until it hangs level in the middle, with the pen down",
        },
    .alter = alter,
    .needs = needs_body,
};

}  // namespace chaintrue::model::plotter::servo_arm_effect
