// SPDX-License-Identifier: GPL-3.0-or-later
// The bound of the largest of many errors, against cases with a known distribution.
#include "grid/map/largest_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace chaintrue::grid {
namespace {

/// Four sigmas of a quantile of 400 draws, by its density, in sigmas.
double tolerance(double density) { return 4.0 * std::sqrt(0.95 * 0.05 / 400.0) / density; }

TEST(LargestError, WithoutUncertaintyIsTheMaximum) {
  LargestError largest;
  EXPECT_EQ(largest.bound_mm(), 0.0);
  for (const double mm : {3.0, 5.0, 4.0})
    largest.add({0.6 * mm, -0.8 * mm}, Eigen::Matrix2Xd(2, 0));
  EXPECT_NEAR(largest.bound_mm(), 5.0, 1e-15);
}

// Rayleigh: sqrt(-2 ln 0.05) = 2.448, its density there 0.05 times that.
TEST(LargestError, AtOnePlaceIsItsQuantile) {
  LargestError largest;
  largest.add(Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity());
  EXPECT_NEAR(largest.bound_mm(), 2.448, tolerance(0.05 * 2.448));
}

// Places with equal errors count as one; independent ones are two chances.
TEST(LargestError, UsesTheCorrelations) {
  LargestError together, apart;
  Eigen::Matrix2Xd first = Eigen::Matrix2Xd::Zero(2, 4), second = first;
  first.leftCols<2>() = second.rightCols<2>() = Eigen::Matrix2d::Identity();
  for (int i = 0; i < 100; ++i) together.add(Eigen::Vector2d::Zero(), first);
  for (const auto& spread : {first, second}) apart.add(Eigen::Vector2d::Zero(), spread);
  EXPECT_NEAR(together.bound_mm(), 2.448, tolerance(0.05 * 2.448));
  // 1 - (1 - exp(-b^2 / 2))^2 = 0.05: b = 2.711; the density of the larger of two there is 0.1338.
  EXPECT_NEAR(apart.bound_mm(), 2.711, tolerance(0.1338));
  EXPECT_GT(apart.bound_mm(), together.bound_mm());
}

// Far from zero only the component along the error counts, to one side: 1.645 sigmas.
TEST(LargestError, AddsToTheExpectedError) {
  LargestError largest;
  largest.add({1000.0, 0.0}, Eigen::Matrix2d::Identity());
  EXPECT_NEAR(largest.bound_mm(), 1001.645, tolerance(0.1031));
}

TEST(LargestError, RefusesOtherDirections) {
  LargestError largest;
  largest.add(Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity());
  EXPECT_THROW(largest.add(Eigen::Vector2d::Zero(), Eigen::Matrix2Xd(2, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid
