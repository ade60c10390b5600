// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The covariance of n new readings, split so that it is cheap to invert. Private to grid/map.
///
///   K = N + S S' + F F'                                                                        (1)
///
///   N   each unit's own noise, 1 or 2 rows of a unit                           n x n, by blocks
///   S   errors that some readings share: of a hole, of the sheet's size, of a tape's zero  n x k, sparse
///   F  the map's uncertainty                                   n x m, m <= n
///
/// With N = L L', G = L^-1 [S F] and M = I + G' G it is M that is factored, (k + m)^3, not K:
///
///   |K|^1/2 = |L| |M|^1/2,   x' K^-1 y = X . Y  with  Y = (L^-1 y - G z; z),  M z = G' L^-1 y   (2)
///
/// Y is the residual of a least-squares problem: an error of z enters the products of (2) squared,
/// so that readings far better than the map lose no digits. Source: G. Golub and C. Van Loan,
/// Matrix Computations (2013), sections 2.1.4 and 5.3.
#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <vector>

#include "grid/containers.hpp"
#include "grid/estimation/unit_whitening.hpp"
#include "grid/precondition.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

/// (1). All in mm^2 or mm.
struct ReadingCovariance {
  std::vector<MatrixXd> own;  ///< of each unit, in the order of the rows
  Eigen::SparseMatrix<double> shared;
  MatrixXd of_map;

  Index rows() const { return of_map.rows(); }
  VectorXd diagonal() const {
    VectorXd sum = of_map.rowwise().squaredNorm();
    for (const Index column : each_below(shared.outerSize())) {
      for (Eigen::SparseMatrix<double>::InnerIterator at(shared, column); at; ++at)
        sum[at.row()] += at.value() * at.value();
    }
    Index row = 0;
    for (const MatrixXd& unit : own) {
      sum.segment(row, unit.rows()) += unit.diagonal();
      row += unit.rows();
    }
    return sum;
  }

  /// n x n.
  MatrixXd dense() const {
    MatrixXd sum = linear::outer(of_map);
    sum += MatrixXd(shared * shared.transpose());
    Index row = 0;
    for (const MatrixXd& unit : own) {
      sum.block(row, row, unit.rows(), unit.rows()) += unit;
      row += unit.rows();
    }
    return sum;
  }
};

/// F F' with no more columns than rows.
inline MatrixXd narrowed(const MatrixXd& f) {
  if (f.cols() <= f.rows()) return f;
  return linear::covariance_root(linear::outer(f));
}

/// Immutable, thread safe.
class FactoredCovariance {
 public:
  /// \throws std::invalid_argument where units, S and F have other numbers of rows, or a unit's
  /// noise is not positive.
  explicit FactoredCovariance(const ReadingCovariance& covariance) {
    Index rows = 0;
    std::vector<Eigen::Triplet<double>> entries;
    for (const MatrixXd& own : covariance.own) {
      const MatrixXd& white = whitening_.emplace_back(estimation::unit_whitening(own));
      for (const Index i : each_below(white.rows())) {
        for (Index j = 0; j <= i; ++j) entries.emplace_back(rows + i, rows + j, white(i, j));
        log_root_det_ -= std::log(white(i, i));
      }
      rows += white.rows();
    }
    if (rows != covariance.rows() || rows != covariance.shared.rows()) {
      throw precondition("readings of {} rows in units, {} of shared errors, {} of the map", rows,
                         covariance.shared.rows(), covariance.rows());
    }
    if (!std::isfinite(log_root_det_))
      throw precondition("readings whose noise is not positive: log |L| = {}", log_root_det_);
    white_.resize(rows, rows);
    white_.setFromTriplets(entries.begin(), entries.end());
    shared_ = white_ * covariance.shared;
    of_map_ = white_ * covariance.of_map;
    factor_ = linear::Cholesky(gram());
    log_root_det_ += 0.5 * factor_.log_det();
  }

  /// Y of (2), for each column of y (n x any).
  MatrixXd conditioned(const MatrixXd& y) const {
    const MatrixXd white = white_ * y;
    const MatrixXd z = factor_.solve(by_columns(white));
    MatrixXd result(white.rows() + z.rows(), y.cols());
    result.topRows(white.rows()) = white - shared_ * z.topRows(shared_.cols()) -
                                   linear::product(of_map_, z.bottomRows(of_map_.cols()));
    result.bottomRows(z.rows()) = z;
    return result;
  }

  /// log |K|^1/2
  double log_root_det() const { return log_root_det_; }
  /// K^-1 y from one Y.
  VectorXd pulled(const VectorXd& conditioned) const {
    return white_.transpose() * conditioned.head(white_.rows());
  }

  /// The diagonal blocks of K^-1, by units.
  std::vector<MatrixXd> precision_of_units() const {
    std::vector<MatrixXd> result;
    Index row = 0;
    for (const MatrixXd& white : whitening_) {
      MatrixXd by_row(columns(), white.rows());
      by_row << MatrixXd(shared_.middleRows(row, white.rows())).transpose(),
          of_map_.middleRows(row, white.rows()).transpose();
      // The variance of a unit given all other readings is at most its prior variance.
      const linear::SymmetricEigen parts(linear::gram(factor_.half_solve(by_row)));
      const VectorXd left =
          (1.0 - parts.eigenvalues().array()).max(1.0 / (1.0 + by_row.squaredNorm()));
      const MatrixXd turned = linear::inner(parts.eigenvectors(), white);
      result.push_back(linear::gram(left.cwiseSqrt().asDiagonal() * turned));
      row += white.rows();
    }
    return result;
  }

 private:
  Index columns() const { return shared_.cols() + of_map_.cols(); }
  MatrixXd gram() const {
    const Index k = shared_.cols();
    const Index m = of_map_.cols();
    MatrixXd gram = MatrixXd::Identity(k + m, k + m);
    if (k > 0) {
      gram.topLeftCorner(k, k) += MatrixXd(shared_.transpose() * shared_);
      gram.bottomLeftCorner(m, k) = (shared_.transpose() * of_map_).transpose();
    }
    gram.bottomRightCorner(m, m) = linear::one_plus_gram(of_map_);
    return gram;
  }

  MatrixXd by_columns(const MatrixXd& white) const {
    MatrixXd result(columns(), white.cols());
    result.topRows(shared_.cols()) = shared_.transpose() * white;
    result.bottomRows(of_map_.cols()) = linear::inner(of_map_, white);
    return result;
  }

  std::vector<MatrixXd> whitening_;                      ///< L^-1 of each unit
  Eigen::SparseMatrix<double, Eigen::RowMajor> white_;   ///< L^-1
  Eigen::SparseMatrix<double, Eigen::RowMajor> shared_;  ///< L^-1 S
  MatrixXd of_map_;                                      ///< L^-1 F
  linear::Cholesky factor_;                              ///< of M
  double log_root_det_ = 0.0;
};

}  // namespace chaintrue::grid
