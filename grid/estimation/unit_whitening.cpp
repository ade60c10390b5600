// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/unit_whitening.hpp"

#include <cmath>

#include "grid/precondition.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::estimation {

MatrixXd unit_whitening(const MatrixXd& covariance) {
  const Index n = covariance.rows();
  if (n < 1 || n > kMostUnitReadings || covariance.cols() != n) {
    throw precondition(
        "the covariance of a unit's readings is {} x {}; 1 to {} readings are allowed", n,
        covariance.cols(), kMostUnitReadings);
  }
  if (n == 1) return MatrixXd::Constant(1, 1, 1.0 / std::sqrt(covariance(0, 0)));
  return linear::Cholesky(covariance).half_solve(MatrixXd::Identity(n, n));
}

}  // namespace chaintrue::grid::estimation
