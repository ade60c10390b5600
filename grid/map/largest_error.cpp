// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/largest_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "interp/linear_algebra.hpp"
#include "grid/precondition.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid {
namespace {

/// The quantile's level is then known to 1.1 %: sqrt(0.95 * 0.05 / 400).
constexpr Eigen::Index kDraws = 400;
constexpr double kLevel = 0.95;

Eigen::MatrixXd drawn(Eigen::Index directions) {
  constexpr std::uint64_t kSeed = 95;
  Random random(kSeed);
  Eigen::MatrixXd draws(directions, kDraws);
  for (double& z : draws.reshaped()) z = random.normal();
  return draws;
}

}  // namespace

void LargestError::add(const Eigen::Vector2d& expected_mm, const Eigen::Matrix2Xd& spread_mm) {
  if (largest_mm2_.size() == 0) {
    draws_ = drawn(spread_mm.cols());
    largest_mm2_ = Eigen::RowVectorXd::Zero(kDraws);
  }
  if (spread_mm.cols() != draws_.rows())
    throw precondition("a spread of {} columns after one of {}", spread_mm.cols(), draws_.rows());
  Eigen::MatrixXd errors = linear::product(spread_mm, draws_);
  errors.colwise() += expected_mm;
  largest_mm2_ = largest_mm2_.cwiseMax(errors.colwise().squaredNorm());
}

double LargestError::bound_mm() const {
  if (largest_mm2_.size() == 0) return 0.0;
  Eigen::RowVectorXd sorted = largest_mm2_;
  const auto at = static_cast<Eigen::Index>(kLevel * static_cast<double>(kDraws));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return std::sqrt(sorted[at]);
}

}  // namespace chaintrue::grid
