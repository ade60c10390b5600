// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The symmetric square root of a covariance V = I + A A' with few columns in A: noise of one and a
/// few unknowns that all rows share. Of the thin A = U diag(a) W',
///   V^p = I + U diag((1 + a^2)^p - 1) U'
/// so that nothing of size rows x rows is made (G. Golub and C. Van Loan, Matrix Computations, 4th
/// edition (2013), section 2.1.4 on low-rank changes). A product loses to rounding what a factor's
/// would: some 1e-16 of what it is given.
///
///   const CovarianceRoot root(a);                  // rows x unknowns
///   const Eigen::MatrixXd white = root.solve(m);   // its rows have a covariance of I
#pragma once

#include <Eigen/Core>
#include <vector>

#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::diagnosis {

class CovarianceRoot {
 public:
  CovarianceRoot() = default;
  /// \param a  rows x unknowns, either may be 0.
  explicit CovarianceRoot(const Eigen::MatrixXd& a);

  /// V^(-1/2) m.
  template <class M>
  [[nodiscard]] linear::Like<M> solve(const M& m) const {
    return multiplied<linear::Like<M>>(-0.5, m);
  }
  /// V^(1/2) m.
  template <class M>
  [[nodiscard]] linear::Like<M> times(const M& m) const {
    return multiplied<linear::Like<M>>(0.5, m);
  }
  /// These columns of V^(-1/2).
  [[nodiscard]] Eigen::MatrixXd inverse(const std::vector<Eigen::Index>& columns) const;
  /// The block of V^(-1) of this size that starts at these indices.
  [[nodiscard]] Eigen::MatrixXd precision_block(Eigen::Index row,
                                                Eigen::Index rows,
                                                Eigen::Index column,
                                                Eigen::Index columns) const;
  [[nodiscard]] double log_det() const { return log_variance_.sum(); }

 private:
  /// V^exponent m.
  template <class M>
  [[nodiscard]] M multiplied(double exponent, M m) const {
    multiply(exponent, m);
    return m;
  }
  void multiply(double exponent, Eigen::Ref<Eigen::MatrixXd> m) const;
  [[nodiscard]] Eigen::VectorXd change(double exponent) const;
  Eigen::MatrixXd basis_;        ///< U
  Eigen::ArrayXd log_variance_;  ///< log(1 + a^2)
};

}  // namespace chaintrue::grid::diagnosis
