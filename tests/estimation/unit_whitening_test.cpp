// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/unit_whitening.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <stdexcept>

#include "grid/random.hpp"

namespace chaintrue::grid::estimation {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, Random& random) {
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < columns; ++k) matrix(i, k) = random.normal();
  }
  return matrix;
}

double largest(const Eigen::MatrixXd& matrix) { return matrix.cwiseAbs().maxCoeff(); }

// A dozen products of numbers near one: a thousand times the rounding.
constexpr double kRoundingOfSums = 1e-12;

TEST(UnitWhitening, BringsReadingsToUnitsOfNoiseAndBack) {
  constexpr std::uint64_t kSeed = 3;
  SCOPED_TRACE(kSeed);
  Random random(kSeed);
  for (Eigen::Index n = 1; n <= kMostUnitReadings; ++n) {
    SCOPED_TRACE(n);
    const Eigen::MatrixXd root = random_matrix(n, n, random);
    const Eigen::MatrixXd covariance = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd w = unit_whitening(covariance);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
    EXPECT_LT(largest(w * covariance * w.transpose() - one), kRoundingOfSums);
    EXPECT_LT(largest(w * w.inverse() - one), kRoundingOfSums);
    EXPECT_EQ(w.rows(), n);
  }
}

TEST(UnitWhiteningBadInput, RefusesTooManyReadings) {
  EXPECT_THROW((void)unit_whitening(Eigen::MatrixXd::Identity(5, 5)), std::invalid_argument);
  EXPECT_THROW((void)unit_whitening(Eigen::MatrixXd(0, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid::estimation
