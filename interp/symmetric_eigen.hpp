// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Eigenvalues of symmetric matrices, compiled once, since Eigen's solver is the template that
/// takes longest to compile. Internal to interp and to grid/linear_algebra.

#include <Eigen/Core>

namespace chaintrue::interp {

/// matrix = vectors diag(values) vectors', values ascending, columns orthonormal; only the lower
/// triangle of the n x n matrix is read.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(const Eigen::MatrixXd& matrix);
  [[nodiscard]] const Eigen::VectorXd& eigenvalues() const { return values_; }
  [[nodiscard]] const Eigen::MatrixXd& eigenvectors() const { return vectors_; }

 private:
  Eigen::VectorXd values_;
  Eigen::MatrixXd vectors_;
};

}  // namespace chaintrue::interp
