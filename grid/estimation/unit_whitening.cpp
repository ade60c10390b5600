// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/unit_whitening.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "interp/linear_algebra.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::estimation {

UnitWhitening::UnitWhitening(const Eigen::MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows();
  if (n < 1 || n > kMostUnitReadings || covariance.cols() != n) {
    throw precondition("the covariance of a unit's readings is {} x {}; 1 to {} readings are allowed",
                       n,
                       covariance.cols(),
                       kMostUnitReadings);
  }
  if (n == 1) {
    matrix_ = Matrix::Constant(1, 1, 1.0 / std::sqrt(covariance(0, 0)));
  } else if (n == 2) {
    const Eigen::Matrix2d lower = Eigen::LLT<Eigen::Matrix2d>(covariance).matrixL();
    matrix_ = lower.inverse();
  } else {
    matrix_ = linear::Cholesky(covariance).half_solve(Eigen::MatrixXd::Identity(n, n));
  }
}

UnitWhitening::Matrix UnitWhitening::inverse() const {
  if (rows() == 1) return matrix_.cwiseInverse();
  if (rows() == 2) return Eigen::Matrix2d(matrix_).inverse();
  return matrix_.triangularView<Eigen::Lower>().solve(Matrix::Identity(rows(), rows()));
}

}  // namespace chaintrue::grid::estimation
