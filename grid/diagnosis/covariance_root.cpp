// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/covariance_root.hpp"

#include <Eigen/SVD>

namespace chaintrue::grid::diagnosis {

CovarianceRoot::CovarianceRoot(const Eigen::MatrixXd& a) : basis_(a.rows(), 0) {
  if (a.rows() == 0 || a.cols() == 0) return;
  const auto take = [&](const auto& svd) {
    basis_ = svd.matrixU();
    log_variance_ = svd.singularValues().array().square().log1p();
  };
  take(Eigen::BDCSVD<Eigen::MatrixXd>(a, Eigen::ComputeThinU));
  // Of finite matrices with singular values that are nearly equal Eigen 3.4.0's division makes NaN; rotations
  // are slower and do not.
  if (!basis_.allFinite() || !log_variance_.allFinite())
    take(Eigen::JacobiSVD<Eigen::MatrixXd>(a, Eigen::ComputeThinU));
}

Eigen::MatrixXd CovarianceRoot::power(double exponent, const Eigen::MatrixXd& m) const {
  if (basis_.cols() == 0 || m.cols() == 0) return m;
  const Eigen::VectorXd change = (exponent * log_variance_).exp() - 1.0;
  Eigen::MatrixXd result = m;
  result.noalias() += basis_ * (change.asDiagonal() * (basis_.transpose() * m));
  return result;
}

Eigen::MatrixXd CovarianceRoot::solve(const Eigen::MatrixXd& m) const { return power(-0.5, m); }

Eigen::MatrixXd CovarianceRoot::times(const Eigen::MatrixXd& m) const { return power(0.5, m); }

Eigen::MatrixXd CovarianceRoot::inverse() const {
  return power(-0.5, Eigen::MatrixXd::Identity(basis_.rows(), basis_.rows()));
}

Eigen::MatrixXd CovarianceRoot::precision_block(Eigen::Index row,
                                                Eigen::Index rows,
                                                Eigen::Index column,
                                                Eigen::Index columns) const {
  const Eigen::VectorXd change = (-log_variance_).exp() - 1.0;
  Eigen::MatrixXd result = basis_.middleRows(row, rows) *
                           (change.asDiagonal() * basis_.middleRows(column, columns).transpose());
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Eigen::Index own = column + k - row;
    if (own >= 0 && own < rows) result(own, k) += 1.0;
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis
