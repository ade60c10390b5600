// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From the readings of a unit to units of noise.
///
///   W C W' = I,   W lower triangular                                                          (1)
///
/// for readings with covariance C. Source: G. Golub and C. Van Loan, Matrix Computations (2013), section 6.1.
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

  [[nodiscard]] const Matrix& matrix() const { return matrix_; }
  [[nodiscard]] Eigen::Index rows() const { return matrix_.rows(); }
  /// W^-1.
  [[nodiscard]] Matrix inverse() const;

  template <class Readings>
  [[nodiscard]] auto operator*(const Eigen::MatrixBase<Readings>& readings) const {
    return matrix_ * readings.derived();
  }

 private:
  Matrix matrix_;
};

}  // namespace chaintrue::grid::estimation
