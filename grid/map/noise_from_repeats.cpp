// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/noise_from_repeats.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "grid/observation/length_points.hpp"

namespace chaintrue::grid {

std::optional<RepeatNoise> noise_from_repeats(const PointsFit& fit,
                                              const observation::PointNoise& noise) {
  std::vector<LengthPoint> good;
  std::vector<Eigen::Vector2d> whitened;
  for (const FittedPoint& point : fit.points) {
    if (point.bad) continue;
    const Eigen::Matrix2d covariance =
        noise.length_mm * noise.length_mm * Eigen::Matrix2d::Identity() +
        noise.position_mm * noise.position_mm * point.mark_jacobian *
            point.mark_jacobian.transpose();
    const Eigen::LLT<Eigen::Matrix2d> factor(covariance);
    good.push_back(point.point);
    whitened.emplace_back(factor.matrixL().solve(point.residual_mm));
  }
  double squares = 0.0;
  double dof = 0.0;
  for (const auto& group : repeat_groups(good)) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (std::size_t i : group) mean += whitened[i] / static_cast<double>(group.size());
    for (std::size_t i : group) squares += (whitened[i] - mean).squaredNorm();
    dof += 2.0 * static_cast<double>(group.size() - 1);
  }
  constexpr double kFewestDof = 4.0;
  if (dof < kFewestDof || squares == 0.0) return std::nullopt;
  return RepeatNoise{std::sqrt(squares / dof), dof};
}

}  // namespace chaintrue::grid
