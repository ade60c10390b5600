// SPDX-License-Identifier: GPL-3.0-or-later
// The factored covariance of new readings compared with the full matrix.
#include "grid/map/reading_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "grid/random.hpp"

namespace chaintrue::grid {
namespace {

Eigen::MatrixXd normal(Random& random, Eigen::Index rows, Eigen::Index cols) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&random] { return random.normal(); });
}

/// Outlier groups of two rows and of one, errors shared by four readings each, and a map of
/// `columns` unknowns.
ReadingCovariance drawn(std::uint64_t seed, int units, Eigen::Index columns, double noise_mm) {
  Random random(seed, 19);
  ReadingCovariance k;
  Eigen::Index rows = 0;
  for (int u = 0; u < units; ++u) {
    const Eigen::Index own = 1 + u % 2;
    const Eigen::MatrixXd root = noise_mm * normal(random, own, own);
    k.own.emplace_back(root * root.transpose() +
                       noise_mm * noise_mm * Eigen::MatrixXd::Identity(own, own));
    rows += own;
  }
  k.shared.resize(rows, units / 4);
  for (Eigen::Index column = 0; column < k.shared.cols(); ++column) {
    for (int i = 0; i < 4; ++i)
      k.shared.coeffRef(static_cast<Eigen::Index>(random.uniform() * static_cast<double>(rows)),
                        column) = 0.3 * random.normal();
  }
  k.of_map = narrowed(0.1 * normal(random, rows, columns));
  return k;
}

constexpr std::uint64_t kSeed = 1;

TEST(ReadingCovariance, IsFactoredAsTheWholeMatrixIs) {
  // More rows than unknowns of the map, and fewer.
  for (const Eigen::Index columns : {0, 7, 200}) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", columns " << columns);
    const ReadingCovariance k = drawn(kSeed, 61, columns, 0.4);
    const Eigen::MatrixXd dense = k.dense();
    const FactoredCovariance factored(k);
    Random random(kSeed, 20);
    const Eigen::MatrixXd y = normal(random, k.rows(), 3);
    const Eigen::MatrixXd conditioned = factored.conditioned(y);
    const Eigen::MatrixXd inverse = dense.inverse();
    // Rounding of matrices of condition 1e4 at most.
    constexpr double kRounding = 1e-10;
    EXPECT_LT((k.diagonal() - dense.diagonal()).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LT(
        (conditioned.transpose() * conditioned - y.transpose() * inverse * y).cwiseAbs().maxCoeff(),
        kRounding * static_cast<double>(k.rows()) * 10.0);
    EXPECT_LT((factored.pulled(conditioned.col(1)) - inverse * y.col(1)).cwiseAbs().maxCoeff(),
              kRounding * 10.0);
    EXPECT_NEAR(factored.log_root_det(), 0.5 * std::log(dense.determinant()), 1e-9) << "rounding";
    Eigen::Index row = 0;
    for (const Eigen::MatrixXd& own : factored.precision_of_units()) {
      EXPECT_LT((own - inverse.block(row, row, own.rows(), own.rows())).cwiseAbs().maxCoeff(),
                kRounding * 10.0);
      row += own.rows();
    }
    EXPECT_EQ(row, k.rows());
  }
}

// A residual within the map's own uncertainty counts by that uncertainty alone, however small the
// noise: with y = F z, y' K^-1 y tends to z' z where F has full rank.
TEST(ReadingCovariance, ReadingsFarBetterThanTheMapLoseNoDigits) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  constexpr double kFineMm = 1e-6;
  ReadingCovariance k = drawn(kSeed, 61, 7, kFineMm);
  k.shared.resize(k.rows(), 0);
  const FactoredCovariance factored(k);
  Random random(kSeed, 21);
  const Eigen::VectorXd z = normal(random, 7, 1);
  // (kFineMm / 0.1)^2 is neglected in the limit; 1e-8 covers it, with rounding over 90 rows.
  EXPECT_NEAR(factored.conditioned(k.of_map * z).squaredNorm(), z.squaredNorm(), 1e-8);
  for (const Eigen::MatrixXd& own : factored.precision_of_units())
    EXPECT_GT(own.diagonal().minCoeff(), 0.0);
}

TEST(ReadingCovariance, NarrowedIsTheSameWithFewerColumns) {
  Random random(kSeed, 22);
  const Eigen::MatrixXd f = normal(random, 6, 40);
  const Eigen::MatrixXd narrow = narrowed(f);
  EXPECT_EQ(narrow.cols(), 6);
  EXPECT_LT((narrow * narrow.transpose() - f * f.transpose()).cwiseAbs().maxCoeff(), 1e-12)
      << "rounding of sums of 40";
  EXPECT_EQ(narrowed(f.leftCols(3)), f.leftCols(3));
}

TEST(ReadingCovariance, RefusesInvalidMatrices) {
  ReadingCovariance k = drawn(1, 5, 2, 0.4);
  k.own[2](0, 0) = 0.0;
  EXPECT_THROW(FactoredCovariance{k}, std::invalid_argument);
  k = drawn(1, 5, 2, 0.4);
  k.own.pop_back();
  EXPECT_THROW(FactoredCovariance{k}, std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid
