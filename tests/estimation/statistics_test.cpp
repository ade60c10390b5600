// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace chaintrue::grid {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();

TEST(Statistics, TheMedianIsTheMiddle) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_THROW((void)median({}), std::invalid_argument);
}

TEST(Statistics, RootMeanSquaresCountEveryComponent) {
  EXPECT_DOUBLE_EQ(rms(std::vector<double>{3.0, 4.0}), std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(rms(std::vector<Eigen::Vector2d>{{3.0, 4.0}}), std::sqrt(12.5));
  EXPECT_EQ(rms(std::vector<double>{}), 0.0);
  EXPECT_DOUBLE_EQ(rms_length({{3.0, 4.0}, {0.0, 0.0}}), std::sqrt(12.5));
  EXPECT_EQ(rms_length({}), 0.0);
}

TEST(Statistics, SumsOfExponentialsDoNotOverflow) {
  // Two rounding errors at this size.
  EXPECT_NEAR(log_sum(1000.0, 1000.0), 1000.0 + std::log(2.0), 3e-13);
  EXPECT_NEAR(log_sum({-1000.0, -1000.0, -1000.0}), -1000.0 + std::log(3.0), 3e-13);
  EXPECT_EQ(log_sum(kNothing, 3.0), 3.0);
  EXPECT_EQ(log_sum(kNothing, kNothing), kNothing);
  EXPECT_EQ(log_sum({}), kNothing);
}

}  // namespace
}  // namespace chaintrue::grid
