// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/noise_from_repeats.hpp"

#include "grid/observation/length_points.hpp"
#include "interp/linear_algebra.hpp"

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

std::optional<RepeatNoise> noise_from_repeats(const std::vector<FittedPoint>& points,
                                              const observation::PointNoise& noise,
                                              const observation::PointNoise& rounding) {
  std::vector<FittedPoint> good = points;
  std::erase_if(good, [](const FittedPoint& point) { return point.is_rejected(); });
  RepeatScatter scatter(noise, rounding);
  for (const auto& group : repeat_groups(mapped(good, &FittedPoint::point))) {
    for (const std::size_t i : group) scatter.add(good[i].residual, good[i].mark_jacobian);
    scatter.end_group();
  }
  return scatter.noise();
}

void RepeatScatter::add(const Vector2d& residual_mm, const Matrix2d& by_mark) {
  const linear::Cholesky factor(observation::covariance_of(noise_, by_mark));
  group_.emplace_back(factor.half_solve(VectorXd(residual_mm)));
  const MatrixXd rounding = observation::covariance_of(rounding_, by_mark);
  rounding_squares_ += factor.solve(rounding).trace();
  rows_ += 2.0;
}

void RepeatScatter::end_group() {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& w : group_) mean += w / as_double(group_.size());
  for (const Vector2d& w : group_) squares_ += (w - mean).squaredNorm();
  if (!group_.empty()) dof_ += 2.0 * as_double(group_.size() - 1);
  group_.clear();
}

}  // namespace chaintrue::grid
