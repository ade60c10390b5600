// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_commands.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace chaintrue::model {
namespace {

/// Where circles about the pins meet below them, in the machine's frame.
tl::expected<BedPoint, PlotterFailure> circles_meet(const PlotterMachine& as_set, double rise_mm,
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
tl::expected<BedPoint, PlotterFailure> newton_below(const PlotterMachine& as_set, ChainLengths own,
                                                    BedPoint start) {
  constexpr int kMostSteps = 60;
  constexpr double kConvergedMm = 1e-9;
  constexpr double kLongestStepMm = 100.0;
  BedPoint point = start;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto inside = paid_out(PlotterFirmware::mural, as_set, point);
    if (!inside) return tl::unexpected(inside.error());
    const auto here = mural_lengths(as_set, point);
    Eigen::Matrix2d slope;
    slope << here->left.d[0], here->left.d[1], here->right.d[0], here->right.d[1];
    const Eigen::Vector2d move =
        slope.inverse() *
        Eigen::Vector2d(own.left_mm - here->left.value, own.right_mm - here->right.value);
    if (!move.allFinite()) break;
    const double longer = std::max(1.0, move.norm() / kLongestStepMm);
    point = {point.x_mm + move.x() / longer, point.y_mm + move.y() / longer};
    if (move.norm() < kConvergedMm) return point;
  }
  return tl::unexpected(PlotterReason::not_converged);
}

/// The equivalent failure of a pose, with the plotter's sentence as its cause.
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

}  // namespace

tl::expected<ChainLengths, PoseFailure> PlotterController::lengths(BedPoint command) const {
  const auto found = paid_out(firmware_, as_set_,
                              {command.x_mm - pins_middle_.x_mm, command.y_mm - pins_middle_.y_mm});
  if (!found) return tl::unexpected(pose_failure(found.error()));
  return *found;
}

tl::expected<BedPoint, PoseFailure> PlotterController::command(ChainLengths lengths) const {
  ChainLengths own = lengths;
  for (const Side side : kSides) {
    own[side] = (own[side] - as_set_.zero_mm[side]) / (1.0 + 1e-3 * as_set_.scale_mm_per_m[side]);
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
    point = newton_below(as_set_, own, *point);
  }
  if (!point) return tl::unexpected(pose_failure(point.error()));
  return BedPoint{point->x_mm + pins_middle_.x_mm, point->y_mm + pins_middle_.y_mm};
}

}  // namespace chaintrue::model
