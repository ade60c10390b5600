// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From the readings of a unit to units of noise.
///
///   W C W' = I,   W lower triangular                                                          (1)
///
/// for readings with covariance C. Where a place that nobody measured moves all of them, by J, the
/// rows are those combinations that it does not move:
///
///   W J = 0,   W = Q' / sigma,   Q orthonormal, Q' J = 0                                       (2)
///
/// so that four belts that meet at such a place leave two rows. Source: G. Golub and C. Van Loan,
/// Matrix Computations (2013), section 6.1.
#pragma once

#include <Eigen/Core>

namespace chaintrue::grid::estimation {

/// Most readings of one unit: four belts at a place.
inline constexpr int kMostUnitReadings = 4;

class UnitWhitening {
 public:
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostUnitReadings, kMostUnitReadings>;

  /// One reading whose sigma is 1.
  UnitWhitening() : matrix_(Matrix::Identity(1, 1)) {}
  /// (1), of at most kMostUnitReadings readings. \throws std::invalid_argument with more.
  explicit UnitWhitening(const Eigen::MatrixXd& covariance);
  /// (2): readings of one sigma and of different noise; `q` has a column a row of the unit.
  static UnitWhitening projected(const Eigen::Ref<const Eigen::MatrixXd>& q, double sigma);

  [[nodiscard]] const Matrix& matrix() const { return matrix_; }
  [[nodiscard]] Eigen::Index rows() const { return matrix_.rows(); }
  [[nodiscard]] Eigen::Index readings() const { return matrix_.cols(); }
  /// W^-1; of (2) the smallest readings that give the rows, sigma Q.
  [[nodiscard]] Matrix inverse() const;

  template <class Readings>
  [[nodiscard]] auto operator*(const Eigen::MatrixBase<Readings>& readings) const {
    return matrix_ * readings.derived();
  }

 private:
  Matrix matrix_;
};

}  // namespace chaintrue::grid::estimation
