// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/noise_from_repeats.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "grid/containers.hpp"
#include "grid/observation/length_points.hpp"

namespace chaintrue::grid {
namespace {

/// Of the step; readings come with no more digits than a file's.
constexpr double kShareOfStep = 1e-4;
constexpr std::size_t kFewestReadings = 4;
constexpr double kChosenPlacesMm = 5.0;

bool are_multiples(const std::vector<double>& values, double step) {
  return all_of(values, [step](double value) {
    const double steps = value / step;
    return std::abs(steps - std::round(steps)) < kShareOfStep;
  });
}

}  // namespace

double rounding_sigma_mm(const std::vector<double>& readings_mm) {
  constexpr double kInchMm = 25.4;
  constexpr int kDecades = 6;
  if (readings_mm.size() < kFewestReadings || are_multiples(readings_mm, kChosenPlacesMm)) return 0.0;
  std::vector<double> steps{kInchMm / 16.0, kInchMm / 32.0, kInchMm / 64.0};
  for (int decade = 0; decade < kDecades; ++decade) {
    for (const double digit : {1.0, 0.5, 0.2}) steps.push_back(digit * std::pow(10.0, -decade));
  }
  sort(steps, std::greater<>());
  auto* step = find_where(steps, [&](double one) { return are_multiples(readings_mm, one); });
  return step == nullptr ? 0.0 : *step / std::sqrt(12.0);
}

observation::PointNoise rounding_noise(const MeasuredGrid& grid) {
  std::vector<double> lengths, marks;
  for (const MeasuredPoint& point : grid.points) {
    if (point.lengths) {
      lengths.insert(lengths.end(), {point.lengths->left_mm, point.lengths->right_mm});
    } else {
      marks.insert(marks.end(), {point.mark.x_mm, point.mark.y_mm});
    }
  }
  return {rounding_sigma_mm(lengths), rounding_sigma_mm(marks)};
}

void RepeatScatter::add(const Eigen::Vector2d& residual_mm, const Eigen::Matrix2d& by_mark) {
  const Eigen::LLT<Eigen::Matrix2d> factor(observation::covariance_of(noise_, by_mark));
  group_.emplace_back(factor.matrixL().solve(residual_mm));
  const Eigen::Matrix2d rounding = observation::covariance_of(rounding_, by_mark);
  rounding_squares_ += factor.solve(rounding).trace();
  rows_ += 2.0;
}

void RepeatScatter::end_group() {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& w : group_) mean += w / as_double(group_.size());
  for (const Eigen::Vector2d& w : group_) squares_ += (w - mean).squaredNorm();
  if (!group_.empty()) dof_ += 2.0 * as_double(group_.size() - 1);
  group_.clear();
}

std::optional<RepeatNoise> RepeatScatter::noise() const {
  constexpr double kFewestDof = 4.0;
  // Of the noise that residuals are whitened by: repeats that agree so well are copies.
  constexpr double kNothing = 1e-6;
  if (dof_ < kFewestDof) return std::nullopt;
  const double factor = std::sqrt(std::max(squares_ / dof_, rounding_squares_ / rows_));
  return factor > kNothing ? std::optional(RepeatNoise{factor, dof_}) : std::nullopt;
}

std::optional<RepeatNoise> noise_from_repeats(const PointsFit& fit,
                                              const observation::PointNoise& noise,
                                              const observation::PointNoise& rounding) {
  std::vector<LengthPoint> good;
  std::vector<const FittedPoint*> fitted;
  for (const FittedPoint& point : fit.points) {
    if (point.bad) continue;
    good.push_back(point.point);
    fitted.push_back(&point);
  }
  RepeatScatter scatter(noise, rounding);
  for (const auto& group : repeat_groups(good)) {
    for (const std::size_t i : group) scatter.add(fitted[i]->residual_mm, fitted[i]->mark_jacobian);
    scatter.end_group();
  }
  return scatter.noise();
}

}  // namespace chaintrue::grid
