// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stretches of an arc, fitted as they are needed.
#include "tools/gcode/arc_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::gcode {
namespace {

/// Corrections have no waves shorter than some hundred millimetres; what has is seen by the checks.
constexpr double kLongestMm = 120.0;
constexpr double kMostTurnRad = 1.5;
/// Where the interpolation is checked, as shares of the stretch: between the nodes.
constexpr double kChecks[] = {0.155, 0.62};

model::BedPoint difference(const PathSample& sample) {
  return {sample.command.x_mm - sample.target.x_mm, sample.command.y_mm - sample.target.y_mm};
}

}  // namespace

ArcCurve::ArcCurve(const Move& move, const Curve& exact, double bound_mm)
    : move_(move), exact_(exact), bound_mm_(bound_mm) {
  const double share = std::min(kLongestMm / std::max(length_mm(move), 1e-9),
                                kMostTurnRad / std::max(std::fabs(move.arc->sweep_rad), 1e-9));
  stretch_ = std::min(1.0, share);
}

tl::expected<void, CorrectionFailure> ArcCurve::fit(double start) {
  from_ = start;
  to_ = std::min(1.0, start + stretch_);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = std::numbers::pi * static_cast<double>(i) / (kNodes - 1);
    t_[i] = 0.5 * (from_ + to_) - 0.5 * (to_ - from_) * std::cos(angle);
    const auto sample = exact_(t_[i]);
    if (!sample) return tl::unexpected(sample.error());
    value_[i] = difference(*sample);
  }
  usable_ = true;
  for (const double share : kChecks) {
    const auto sample = exact_(from_ + share * (to_ - from_));
    if (!sample) return tl::unexpected(sample.error());
    const model::BedPoint found = correction(sample->t);
    const model::BedPoint known = difference(*sample);
    const double error = std::hypot(found.x_mm - known.x_mm, found.y_mm - known.y_mm);
    usable_ = usable_ && error <= bound_mm_;
  }
  return {};
}

model::BedPoint ArcCurve::correction(double t) const {
  model::BedPoint sum;
  double weights = 0.0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (t == t_[i]) return value_[i];
    const bool end = i == 0 || i + 1 == kNodes;
    const double weight = (i % 2 == 0 ? 1.0 : -1.0) * (end ? 0.5 : 1.0) / (t - t_[i]);
    weights += weight;
    sum.x_mm += weight * value_[i].x_mm;
    sum.y_mm += weight * value_[i].y_mm;
  }
  return {sum.x_mm / weights, sum.y_mm / weights};
}

tl::expected<PathSample, CorrectionFailure> ArcCurve::at(double t, double start) {
  if (t < from_ || t > to_) {
    // A chord as long as the stretch is looked at exactly.
    if (t - start > stretch_) return exact_(t);
    if (const auto fitted = fit(start); !fitted) return tl::unexpected(fitted.error());
  }
  if (!usable_) return exact_(t);
  const Point target = gcode::at(move_, t);
  const model::BedPoint add = correction(t);
  return PathSample{t, target, {target.x_mm + add.x_mm, target.y_mm + add.y_mm, target.z_mm}};
}

}  // namespace chaintrue::gcode
