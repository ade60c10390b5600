// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace chaintrue::interp {

SymmetricEigen::SymmetricEigen(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() == 0) return;  // the solver would take a vector of -1 entries
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  values_ = solver.eigenvalues();
  vectors_ = solver.eigenvectors();
}

}  // namespace chaintrue::interp
