// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/random.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

namespace chaintrue::grid::synthetic {
namespace {

using ::testing::ElementsAre;

// xoshiro256++ and SplitMix64 recomputed independently (in Python integers) from the published
// algorithms.
TEST(Random, IsThePublishedGenerator) {
  Random random(1, 0);
  EXPECT_THAT((std::vector<std::uint64_t>{random.bits(), random.bits(), random.bits()}),
              ElementsAre(8089978747140965633U, 5687923198772495674U, 15915821081677751511U));
  Random other(42, 7);
  EXPECT_THAT((std::vector<std::uint64_t>{other.bits(), other.bits()}),
              ElementsAre(3409545882473857721U, 11773385008288523278U));
}

// A normal number is the quantile of a uniform one. Phi(z) = erfc(-z / sqrt 2) / 2 undoes it, over all three ranges of the approximation.
TEST(NormalQuantile, InvertsTheNormalDistribution) {
  for (const double p : {1e-300, 1e-100, 1e-30, 1e-12, 1e-11, 1e-6, 0.01, 0.074, 0.076, 0.25, 0.5,
                         0.75, 0.93, 0.99}) {
    const double z = normal_quantile(p);
    const double back = 0.5 * std::erfc(-z / std::sqrt(2.0));
    // A relative error of 1e-16 in z turns into z^2 times as much in a tail p; z^2 < 1400 here.
    EXPECT_NEAR(back / p, 1.0, 4e-16 * (2.0 + z * z)) << p;
  }
  EXPECT_EQ(normal_quantile(0.5), 0.0);
  // 97.5 %: Abramowitz and Stegun, table 26.1 (more digits from mpmath).
  // The double nearest to 0.975 is up to 5.6e-17 off, which the density 0.058 turns into 1e-15.
  EXPECT_NEAR(normal_quantile(0.975), 1.9599639845400542355, 1.4e-15);
  EXPECT_THROW(static_cast<void>(normal_quantile(0.0)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(normal_quantile(1.0)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(normal_quantile(NAN)), std::invalid_argument);
}

TEST(PortableLog, AgreesWithTheLibrary) {
  Random random(20, 1);
  SCOPED_TRACE("seed 20, stream 1");
  for (int i = 0; i < 10000; ++i) {
    const double x = std::ldexp(random.uniform(), static_cast<int>(random.below(600)) - 300);
    const double expected = std::log(x);
    // Two units of the result, or of the two parts where they nearly cancel around 1.
    EXPECT_NEAR(portable_log(x), expected, 5e-16 * std::abs(expected) + 2e-16) << x;
  }
  EXPECT_EQ(portable_log(1.0), 0.0);
  EXPECT_THROW(static_cast<void>(portable_log(0.0)), std::invalid_argument);
}

// The fourth moment of t with 4 degrees of freedom does not exist, so its shape is checked by its
// distribution: for t4, P(|t| < c) has a closed form, and the scaled draw is t / sqrt 2.
TEST(Random, DrawsHeavyTailsOfTheSameDeviation) {
  Random random(6, 2);
  SCOPED_TRACE("seed 6, stream 2");
  constexpr int kCount = 200000;
  const auto within = [](double c) {  // P(|t4| < c) = s (3 - s^2) / 2 with s = c / sqrt(4 + c^2)
    const double s = c / std::sqrt(4.0 + c * c);
    return 0.5 * s * (3.0 - s * s);
  };
  std::vector<double> draws;
  for (int i = 0; i < kCount; ++i) draws.push_back(random.heavy_tailed() * std::sqrt(2.0));
  for (const double c : {0.3, 0.741, 1.5, 2.776, 5.0, 10.0}) {
    int count = 0;
    for (const double t : draws) count += std::abs(t) < c;
    const double p = within(c);
    // Four standard errors of a share.
    EXPECT_NEAR(static_cast<double>(count) / kCount, p, 4.0 * std::sqrt(p * (1.0 - p) / kCount))
        << c;
  }
}

TEST(Random, DrawsUniformsStrictlyBetweenTheEnds) {
  Random random(7, 0);
  SCOPED_TRACE("seed 7");
  constexpr int kCount = 100000;
  double least = 1.0, most = 0.0, mean = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform();
    least = std::min(least, u);
    most = std::max(most, u);
    mean += u / kCount;
  }
  EXPECT_GT(least, 0.0);
  EXPECT_LT(most, 1.0);
  EXPECT_NEAR(mean, 0.5, 4.0 / std::sqrt(12.0 * kCount));  // four standard errors
}

TEST(Random, ChoosesNumbersUniformly) {
  Random random(8, 0);
  SCOPED_TRACE("seed 8");
  constexpr int kCount = 70000, kKinds = 7;
  std::vector<int> found(kKinds, 0);
  for (int i = 0; i < kCount; ++i) ++found.at(random.below(kKinds));
  double chi2 = 0.0;
  for (const int n : found)
    chi2 += (n - kCount / kKinds) * (n - kCount / kKinds) / static_cast<double>(kCount / kKinds);
  EXPECT_LT(chi2, 22.5);  // 99.9 % of chi-squared with 6 degrees of freedom
  EXPECT_THROW(static_cast<void>(random.below(0)), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid::synthetic
