// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/noise_from_repeats.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {
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

StatedNoise not_below_rounding(StatedNoise stated, const MeasuredGrid& grid) {
  const observation::PointNoise rounding = rounding_noise(grid);
  stated.length_mm = std::max(stated.length_mm, rounding.length_mm);
  stated.position_mm = std::max(stated.position_mm, rounding.position_mm);
  return stated;
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
  // For the noise that residuals are whitened by: repeats that agree so well are copies.
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
