// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The statistics of the sealed rates, compared with published and closed-form values.
#include "sealed/judge/binomial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace chaintrue::sealed {
namespace {

constexpr double kDigits = 1e-10;      // of closed forms: lgamma of a few hundred to 1e-13
constexpr double kPrinted = 5e-5;      // of values that are printed with four digits

TEST(Binomial, TailsOfFewTrialsAreTheirSums) {
  EXPECT_NEAR(probability_of_at_least(0, 5, 0.3), 1.0, kDigits);
  EXPECT_NEAR(probability_of_at_least(5, 5, 0.3), std::pow(0.3, 5), kDigits);
  EXPECT_NEAR(probability_of_at_least(1, 5, 0.3), 1.0 - std::pow(0.7, 5), kDigits);
  EXPECT_NEAR(probability_of_at_least(3, 4, 0.5), 5.0 / 16.0, kDigits);
  EXPECT_EQ(probability_of_at_least(6, 5, 0.3), 0.0);
  EXPECT_EQ(probability_of_at_least(1, 5, 0.0), 0.0);
  EXPECT_EQ(probability_of_at_least(5, 5, 1.0), 1.0);
  EXPECT_THROW((void)probability_of_at_least(1, 5, 1.1), std::invalid_argument);
}

// A tool with 10 % false alarms has at most three in 20 sets in 87 of 100 runs: why no test of a few
// dozen sets can guarantee a rate.
TEST(Binomial, BoundsOfFewTrialsAreWide) {
  EXPECT_NEAR(1.0 - probability_of_at_least(4, 20, 0.1), 0.8670, kPrinted);
}

TEST(Binomial, TailsFarOutKeepTheirDigits) {
  const double far = probability_of_at_least(100, 100, 0.01);
  EXPECT_NEAR(far / 1e-200, 1.0, 1e-9);  // the exponential of 460 times 1e-13 or so
}

// Clopper and Pearson: for no hit and for all hits the bounds have a closed form; 8 of 10 and 5 of
// 50 as printed by tables and by R's binom.test.
TEST(Binomial, BoundsOfARate) {
  EXPECT_EQ(rate_bounds_95(0, 200).lower, 0.0);
  EXPECT_NEAR(rate_bounds_95(0, 200).upper, 1.0 - std::pow(0.025, 1.0 / 200.0), kDigits);
  EXPECT_NEAR(rate_bounds_95(50, 50).lower, std::pow(0.025, 1.0 / 50.0), kDigits);
  EXPECT_EQ(rate_bounds_95(50, 50).upper, 1.0);
  EXPECT_NEAR(rate_bounds_95(8, 10).lower, 0.4439, kPrinted);
  EXPECT_NEAR(rate_bounds_95(8, 10).upper, 0.9748, kPrinted);
  EXPECT_NEAR(rate_bounds_95(5, 50).lower, 0.0333, kPrinted);
  EXPECT_NEAR(rate_bounds_95(5, 50).upper, 0.2181, kPrinted);
  EXPECT_EQ(rate_bounds_95(0, 0).lower, 0.0);
  EXPECT_EQ(rate_bounds_95(0, 0).upper, 1.0);
  EXPECT_THROW((void)rate_bounds_95(3, 2), std::invalid_argument);
}

// Coverage of the bounds: the true rate is outside in at most 5 % of all counts, for every rate.
TEST(Binomial, BoundsHoldTheTrueRate) {
  constexpr int kOf = 60;
  for (const double p : {0.01, 0.05, 0.3, 0.5, 0.9, 0.99}) {
    double outside = 0.0;
    for (int k = 0; k <= kOf; ++k) {
      const RateBounds bounds = rate_bounds_95(k, kOf);
      if (p >= bounds.lower && p <= bounds.upper) continue;
      outside += probability_of_at_least(k, kOf, p) - probability_of_at_least(k + 1, kOf, p);
    }
    EXPECT_LE(outside, 0.05) << p;
  }
}

// Twice the one-sided chance is McNemar's exact test: 16 against 6 of 22 is 0.0525, 8 against 2 of
// ten 0.1094.
TEST(Binomial, SignTest) {
  EXPECT_NEAR(2.0 * sign_test(16, 6), 0.0525, kPrinted);
  EXPECT_NEAR(2.0 * sign_test(8, 2), 0.1094, kPrinted);
  EXPECT_NEAR(sign_test(5, 0), 1.0 / 32.0, kDigits);
  EXPECT_NEAR(sign_test(0, 5), 1.0, kDigits);
  EXPECT_NEAR(sign_test(0, 0), 1.0, kDigits);
  EXPECT_THROW((void)sign_test(-1, 2), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::sealed
