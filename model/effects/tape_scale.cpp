// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// tape_scale: the tape that set out the marks is long or short.
///   x, y  true position of the mark [mm]
///   s     scale, written length over true length less one
///
///   x_written = x (1 + s),  y_written = y (1 + s)                                           (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::tape_scale_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "scale",
    .symbol = "s",
    .meaning = "written distance over true distance, less one",
    .nominal = 0.0005,
    .lower = -0.05,
    .upper = 0.05,
    .prior_sigma = 0.0005,
}};

// (1)
MarkPoint write(MarkPoint mark, EffectSide side, Values values) {
  const double factor = 1.0 + values[0];
  if (side != EffectSide::y) mark.x_mm *= factor;
  if (side != EffectSide::x) mark.y_mm *= factor;
  return mark;
}

}  // namespace

extern constinit const Effect tape_scale{
    .id = "tape_scale",
    .station = Station::paper,
    .sides = kPaperAxes,
    .parameters = kParameters,
    .cause = "the tape or the printed sheet that set out the marks is long or short",
    .signature = "errors grow evenly from the bed's centre outwards, along x, along y or both",
    .equation = "x_written = x (1 + s); y_written = y (1 + s)",
    .source =
        "EU directive 2014/32/EU annex X: a class II tape may err by 0.3 mm + 0.2 mm per metre",
    .not_modelled = "a scale that differs along the tape, or a tape that sags between the marks",
    .typical = "0.05 %, 0.5 mm on a metre",
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy =
        "check the tape against a second one over the whole bed and correct the marks; leave the "
        "machine as it is",
    .write = write,
};

}  // namespace chaintrue::model::effects::tape_scale_effect
