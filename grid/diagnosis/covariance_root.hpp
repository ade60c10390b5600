// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Covariances V = I + A A' with few columns in A: noise of one and unknowns that all rows share, each column
/// in units of its unknown's sigma. Nothing of size rows x rows is made (G. Golub and C. Van Loan, Matrix
/// Computations, 4th edition (2013), section 2.1.4 on low-rank changes). A product loses to rounding what a
/// factor's would: some 1e-16 of what it is given.
///
///   const CovarianceRoot root(a);                  // rows x unknowns
///   const Eigen::MatrixXd white = root.solve(m);   // its rows have a covariance of I
///   const LowRankNoise noise(b);
///   const double square = noise.half_solve(e).squaredNorm();   // e' V^-1 e
#pragma once

#include "grid/containers.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::diagnosis {

/// The symmetric square root. Of the thin A = U diag(a) W',
///   V^p = I + U diag((1 + a^2)^p - 1) U'
class CovarianceRoot {
 public:
  CovarianceRoot() = default;
  /// \param a  rows x unknowns, either may be 0.
  explicit CovarianceRoot(const MatrixXd& a);

  /// V^(-1/2) m.
  template <class M>
  linear::Like<M> solve(const M& m) const {
    linear::Like<M> result = m;
    add_change(result);
    return result;
  }
  /// T with V^-1 = 1 - T T'.
  MatrixXd explained() const;
  double log_det() const { return log_variance_.sum(); }

 private:
  /// m += (V^(-1/2) - 1) m
  void add_change(Eigen::Ref<MatrixXd> m) const;
  VectorXd change(double exponent) const;
  MatrixXd basis_;        ///< U
  ArrayXd log_variance_;  ///< log(1 + a^2)
};

/// At the cost of a Cholesky factorisation of A's columns, for many of them. With c = (1 + A'A)^-1 A'x,
///   V^-1 x = x - A c,   x'V^-1 y = h(x)'h(y),  h(x) = (x - A c, -c):  what least squares of x and no c leave
class LowRankNoise {
 public:
  LowRankNoise() = default;
  /// \param a  rows x columns, either may be 0.
  explicit LowRankNoise(MatrixXd a);

  /// V^-1 x
  template <class X>
  linear::Like<X> solve(const X& x) const {
    return half_solve(x).topRows(x.rows());
  }
  /// h(x), with a row for each of V's and then for each column.
  template <class X>
  linear::Like<X> half_solve(const X& x) const {
    linear::Like<X> result = linear::Like<X>::Zero(x.rows() + a_.cols(), x.cols());
    result.topRows(x.rows()) = x;
    result.bottomRows(a_.cols()) = -normal_.solve(linear::inner(a_, x));
    linear::add_product(result.topRows(x.rows()), 1.0, a_, result.bottomRows(a_.cols()));
    return result;
  }
  /// T with V^-1 = 1 - T T'.
  MatrixXd explained() const;
  double log_det() const { return normal_.log_det(); }

 private:
  MatrixXd a_;
  linear::Cholesky normal_;  ///< 1 + A'A
};

// Inner products of columns under the precision of a marginalised system's rows, with all rows and without some of
// them, from one factorisation.
//
// Notation
//   V     covariance of the rows, settings and further columns of unknown amplitude integrated out:
//         V = R (1 + B B') R, R of the settings, B R^-1 times those columns;  P = V^-1 = 1 - T T'
//   x     columns, given as R^-1 x
//   O     rows left out
//
//   a' V_kept^-1 b = a' P b - (P a)_O' (P_OO)^-1 (P b)_O,   det V_kept = det V det P_OO
//   a_O - V_Ok V_kept^-1 a_k = (P_OO)^-1 (P a)_O
//
// The first line is the inverse of a partitioned matrix and Schur's determinant (G. Golub and C. Van Loan,
// Matrix Computations (2013), section 3.2.11; F. Zhang, The Schur Complement (2005), theorem 1.1).
//
// \code
//   const LeaveOut rows(marginalised.root, LowRankNoise(b), x);
//   const LeaveOut::Kept kept = rows.without({4, 5});
// \endcode

class LeaveOut {
 public:
  LeaveOut() = default;
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
