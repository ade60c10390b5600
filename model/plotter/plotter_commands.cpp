// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_commands.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::model {
namespace {

/// Where circles about the pins meet below them, in the machine's frame.
tl::expected<BedPoint, PlotterFailure> circles_meet(const PlotterMachine& as_set,
                                                    double rise_mm,
                                                    ChainLengths own) {
  const double half = 0.5 * as_set.pin_spacing_mm, up = 0.5 * rise_mm;
  const double apart = 2.0 * std::hypot(half, up);
  const double along =
      (own.left_mm * own.left_mm - own.right_mm * own.right_mm + apart * apart) / (2.0 * apart);
  const double square = (own.left_mm - along) * (own.left_mm + along);
  if (!(square > 0.0) || !(own.left_mm > 0.0) || !(own.right_mm > 0.0))
    return tl::unexpected(PlotterReason::cords_do_not_meet);
  const double below = std::sqrt(square);
  const double c = 2.0 * half / apart, s = 2.0 * up / apart;
  return BedPoint{-half + along * c + below * s, -up + along * s - below * c};
}

/// A mural's tilt bends the relation: Newton from where straight cords would meet.
tl::expected<BedPoint, PlotterFailure> newton_below(const PlotterMachine& as_set,
                                                    ChainLengths lengths,
                                                    BedPoint start) {
  constexpr int kMostSteps = 60;
  constexpr double kConvergedMm = 1e-9;
  // Lengths are exact to about 1e-12 mm, so a difference over 2e-3 mm gives a derivative to 1e-9.
  constexpr double kDifferenceMm = 1e-3;
  constexpr double kLongestStepMm = 100.0;
  const auto at = [&](double x, double y) {
    return paid_out(PlotterFirmware::mural, as_set, {x, y});
  };
  BedPoint point = start;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto here = at(point.x_mm, point.y_mm);
    const auto right = at(point.x_mm + kDifferenceMm, point.y_mm);
    const auto left = at(point.x_mm - kDifferenceMm, point.y_mm);
    const auto over = at(point.x_mm, point.y_mm + kDifferenceMm);
    const auto under = at(point.x_mm, point.y_mm - kDifferenceMm);
    if (!here || !right || !left || !over || !under)
      return tl::unexpected(here ? PlotterFailure(PlotterReason::not_converged) : here.error());
    const double a = (right->left_mm - left->left_mm) / (2.0 * kDifferenceMm);
    const double b = (over->left_mm - under->left_mm) / (2.0 * kDifferenceMm);
    const double c = (right->right_mm - left->right_mm) / (2.0 * kDifferenceMm);
    const double d = (over->right_mm - under->right_mm) / (2.0 * kDifferenceMm);
    const double off_left = lengths.left_mm - here->left_mm;
    const double off_right = lengths.right_mm - here->right_mm;
    const double determinant = a * d - b * c;
    if (!(std::abs(determinant) > 0.0)) break;
    double dx = (d * off_left - b * off_right) / determinant;
    double dy = (a * off_right - c * off_left) / determinant;
    const double longer = std::max(1.0, std::hypot(dx, dy) / kLongestStepMm);
    point = {point.x_mm + dx / longer, point.y_mm + dy / longer};
    if (std::hypot(dx, dy) < kConvergedMm) return point;
  }
  return tl::unexpected(PlotterReason::not_converged);
}

}  // namespace

PoseFailure pose_failure(const PlotterFailure& failure) {
  const auto reason = [&] {
    switch (failure.reason) {
      case PlotterReason::above_the_pins:
        return PoseReason::above_sprockets;
      case PlotterReason::outside_the_pins:
        return PoseReason::outside_verticals;
      case PlotterReason::slack:
        return PoseReason::slack;
      case PlotterReason::cords_do_not_meet:
        return PoseReason::too_short;
      case PlotterReason::not_converged:
        break;
    }
    return PoseReason::not_converged;
  }();
  return PoseFailure(reason).because_of(sentence_of(failure.reason));
}

tl::expected<ChainLengths, PoseFailure> PlotterController::lengths(BedPoint command) const {
  const auto found =
      paid_out(firmware_,
               as_set_,
               {command.x_mm - pins_middle_.x_mm, command.y_mm - pins_middle_.y_mm});
  if (!found) return tl::unexpected(pose_failure(found.error()));
  return *found;
}

tl::expected<BedPoint, PoseFailure> PlotterController::command(ChainLengths lengths) const {
  ChainLengths own = lengths;
  for (const Side side : kSides) {
    own[side] =
        (own[side] - as_set_.zero_mm[side]) / (1.0 + 1e-3 * as_set_.scale_mm_per_m[side]);
  }
  const bool is_mural = firmware_ == PlotterFirmware::mural;
  PlotterMachine about = as_set_;
  // The body is as wide as its pulleys are apart, so its cords meet as if the pins were nearer by
  // that width.
  if (is_mural) about.pin_spacing_mm -= as_set_.gondola.spacing_mm;
  const double rise = firmware_ == PlotterFirmware::fluidnc ? as_set_.pin_rise_mm : 0.0;
  auto point = circles_meet(about, rise, own);
  if (point && is_mural) {
    point->y_mm -= as_set_.gondola.pen_below_mm;
    point = newton_below(as_set_, lengths, *point);
  }
  if (!point) return tl::unexpected(pose_failure(point.error()));
  return BedPoint{point->x_mm + pins_middle_.x_mm, point->y_mm + pins_middle_.y_mm};
}

}  // namespace chaintrue::model
