// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// axes_skew: the marks' axes are not square to each other.
///   x, y  true position of the mark [mm]
///   g     angle between the y axis and the normal of the x axis [rad]
///
///   x_written = x + y g                                                                     (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::axes_skew_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "angle_rad",
    .symbol = "g",
    .meaning = "angle by which the marks' y axis leans, towards -x for a positive angle",
    .nominal = 0.001,
    .lower = -0.05,
    .upper = 0.05,
    .prior_sigma = 0.001,
    .mirror_sign = -1.0,
}};

// (1)
MarkPoint write(MarkPoint mark, EffectSide, Values values) {
  return {mark.x_mm + mark.y_mm * values[0], mark.y_mm};
}

}  // namespace

extern constinit const Effect axes_skew{
    .id = "axes_skew",
    .station = Station::paper,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause = "the axes drawn for the marks are not square to each other",
    .signature =
        "the upper marks are off to one side, the lower ones to the other, in proportion to y",
    .equation = "x_written = x + y g",
    .source = "geometry of an oblique frame, first order in g (g^2/2 is 0.3 um over the bed)",
    .not_modelled = "bent or kinked axes",
    .typical = "1 mrad, 1 mm on a metre",
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy =
        "compare the two diagonals of the marks and correct the marks; leave the machine as it is",
    .write = write,
};

}  // namespace chaintrue::model::effects::axes_skew_effect
