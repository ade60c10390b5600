// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// standoff: the cords' ends at the gondola are farther off the wall than set.
///   d  how much, mm
///
///   standoff += d                                                                           (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::standoff_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "d",
    .meaning = "how much farther off the wall they are than set",
    .nominal = 10.0,
    .lower = -100.0,
    .upper = 100.0,
    .prior_sigma = 10.0,
}};

// (1)
void alter(Statics& m, EffectSide /*side*/, const CordVisit& /*visit*/, Values values) {
  m.standoff_mm += values[0];
}

}  // namespace

extern constinit const PlotterEffect standoff{
    .described =
        {
            .id = "standoff",
            .station = effects::Station::machine,
            .sides = effects::kNoSide,
            .parameters = kParameters,
            .cause = "pins, or the pulleys of the gondola, are nearer to the wall or farther off "
                     "it than set",
            .signature = "short cords are too short by more than long ones: the top of the drawing "
                         "is stretched",
            .equation = "standoff + d",
            .source = "geometry: a cord that slants to the wall",
            .not_modelled = "pins of different depths",
            .typical = "5 to 20 mm",
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy =
                "measure how far pins and pulleys stand off the wall and enter the difference",
        },
    .alter = alter,
};

}  // namespace chaintrue::model::plotter::standoff_effect
