// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Inner products of columns under the precision of a marginalised system's rows, with all rows and without some of
/// them, from one factorisation.
///
/// Notation
///   V     covariance of the rows, settings and further columns of unknown amplitude integrated out:
///         V = R (1 + B B') R, R of the settings, B R^-1 times those columns;  P = V^-1 = 1 - T T'
///   x     columns, given as R^-1 x
///   O     rows left out
///
///   a' V_kept^-1 b = a' P b - (P a)_O' (P_OO)^-1 (P b)_O,   det V_kept = det V det P_OO
///   a_O - V_Ok V_kept^-1 a_k = (P_OO)^-1 (P a)_O
///
/// The first line is the inverse of a partitioned matrix and Schur's determinant (G. Golub and C. Van Loan,
/// Matrix Computations (2013), section 3.2.11; F. Zhang, The Schur Complement (2005), theorem 1.1).
///
/// \code
///   const LeaveOut rows(marginalised.root, LowRankNoise(b), x);
///   const LeaveOut::Kept kept = rows.without({4, 5});
/// \endcode
#pragma once

#include "grid/diagnosis/covariance_root.hpp"
#include "grid/diagnosis/regressor_columns.hpp"
#include "grid/eigen.hpp"

namespace chaintrue::grid::diagnosis {

class LeaveOut {
 public:
  LeaveOut(const CovarianceRoot& root, const LowRankNoise& noise, const MatrixXd& x);

  Index rows() const { return weighed_.rows(); }

  struct Kept {
    MatrixXd inner;          ///< x' V_kept^-1 x
    double log_det = 0.0;    ///< of V_kept
    linear::Cholesky block;  ///< P_OO
    MatrixXd weighed;        ///< (P x)_O
    /// x_O minus its prediction by the kept rows.
    MatrixXd missed() const { return block.solve(weighed); }
  };
  [[nodiscard]] Kept without(const Rows& out) const;

 private:
  MatrixXd explained_;  ///< T
  MatrixXd weighed_;    ///< P x
  MatrixXd inner_;      ///< x' P x
  double log_det_ = 0.0;
};

}  // namespace chaintrue::grid::diagnosis
