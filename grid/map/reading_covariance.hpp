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

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

/// (1). All in mm^2 or mm.
struct ReadingCovariance {
  std::vector<Eigen::MatrixXd> own;  ///< of each unit, in the order of the rows
  Eigen::SparseMatrix<double> shared;
  Eigen::MatrixXd of_map;

  [[nodiscard]] Eigen::Index rows() const { return of_map.rows(); }
  [[nodiscard]] Eigen::VectorXd diagonal() const;
  /// n x n.
  [[nodiscard]] Eigen::MatrixXd dense() const;
};

/// F F' with no more columns than rows.
[[nodiscard]] Eigen::MatrixXd narrowed(const Eigen::MatrixXd& f);

/// Immutable, thread safe.
class FactoredCovariance {
 public:
  /// \throws std::invalid_argument where units, S and F have other numbers of rows, or a unit's
  /// noise is not positive.
  explicit FactoredCovariance(const ReadingCovariance& covariance);

  /// Y of (2), for each column of y (n x any).
  [[nodiscard]] Eigen::MatrixXd conditioned(const Eigen::MatrixXd& y) const;
  /// log |K|^1/2
  [[nodiscard]] double log_root_det() const { return log_root_det_; }
  /// K^-1 y from one Y.
  [[nodiscard]] Eigen::VectorXd pulled(const Eigen::VectorXd& conditioned) const;
  /// The diagonal blocks of K^-1, by units.
  [[nodiscard]] std::vector<Eigen::MatrixXd> precision_of_units() const;

 private:
  [[nodiscard]] Eigen::Index columns() const { return shared_.cols() + of_map_.cols(); }
  [[nodiscard]] Eigen::MatrixXd gram() const;
  [[nodiscard]] Eigen::MatrixXd by_columns(const Eigen::MatrixXd& white) const;

  std::vector<Eigen::MatrixXd> whitening_;               ///< L^-1 of each unit
  Eigen::SparseMatrix<double, Eigen::RowMajor> white_;   ///< L^-1
  Eigen::SparseMatrix<double, Eigen::RowMajor> shared_;  ///< L^-1 S
  Eigen::MatrixXd of_map_;                               ///< L^-1 F
  linear::Cholesky factor_;                              ///< of M
  double log_root_det_ = 0.0;
};

}  // namespace chaintrue::grid
