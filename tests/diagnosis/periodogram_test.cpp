// SPDX-License-Identifier: GPL-3.0-or-later
// Waves along a chain: laws of the periodogram.
#include "grid/diagnosis/periodogram.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kTurnMm = 63.5;
constexpr double kShortestMm = 5.7;

std::vector<double> uneven_places(std::uint64_t seed, std::size_t count) {
  synthetic::Random random(seed, 1);
  std::vector<double> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back(random.uniform(800.0, 3000.0));
  return places;
}

std::vector<double> noise(std::uint64_t seed, std::size_t count) {
  synthetic::Random random(seed, 2);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(random.normal());
  return values;
}

std::vector<double> wave(const std::vector<double>& places, double period_mm, double phase) {
  std::vector<double> values;
  for (const double at : places) {
    values.push_back(std::sin(2.0 * std::numbers::pi * at / period_mm + phase));
  }
  return values;
}

// The definition: the share of the square about the mean that is explained by a least-squares fit
// of a constant, a cosine and a sine beyond a constant alone.
double by_least_squares(const std::vector<double>& places,
                        const std::vector<double>& values,
                        double period_mm) {
  const auto n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd design(n, 3);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double phase = 2.0 * std::numbers::pi * places[static_cast<std::size_t>(i)] / period_mm;
    design.row(i) << 1.0, std::cos(phase), std::sin(phase);
    y(i) = values[static_cast<std::size_t>(i)];
  }
  const Eigen::VectorXd left = y - design * design.colPivHouseholderQr().solve(y);
  const Eigen::VectorXd about_mean = y.array() - y.mean();
  return 1.0 - left.squaredNorm() / about_mean.squaredNorm();
}

TEST(Periodogram, IsTheShareThatLeastSquaresTakes) {
  const auto places = uneven_places(11, 40);
  const auto values = noise(11, 40);
  const Periodogram waves(places, kShortestMm);
  const auto power = waves.power(values);
  ASSERT_EQ(power.size(), waves.periods_mm().size());
  for (std::size_t k = 0; k < power.size(); k += 7) {
    // Two solutions of a well-conditioned problem with three unknowns.
    EXPECT_NEAR(power[k], by_least_squares(places, values, waves.periods_mm()[k]), 1e-8)
        << waves.periods_mm()[k] << " mm";
  }
  EXPECT_NEAR(waves.power_at(kTurnMm, values), by_least_squares(places, values, kTurnMm), 1e-8);
}

TEST(Periodogram, GoesFromTheSpanDownToTheShortestPeriod) {
  const auto places = uneven_places(12, 30);
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  const Periodogram waves(places, kShortestMm);
  EXPECT_DOUBLE_EQ(waves.periods_mm().front(), *high - *low);
  EXPECT_GE(waves.periods_mm().back(), kShortestMm);
  EXPECT_LT(waves.periods_mm().back(), 1.01 * kShortestMm);
  EXPECT_TRUE(std::is_sorted(waves.periods_mm().rbegin(), waves.periods_mm().rend()));
}

TEST(Periodogram, FindsAWaveAtItsPeriodWhateverItsPhaseSizeAndMean) {
  const auto places = uneven_places(13, 34);
  const Periodogram waves(places, kShortestMm);
  for (const double phase : {0.0, 1.0, 2.5, 4.0}) {
    auto values = wave(places, kTurnMm, phase);
    EXPECT_NEAR(waves.power_at(kTurnMm, values), 1.0, 1e-9);  // the wave only
    for (double& v : values) v = 0.01 * v + 7.0;
    EXPECT_NEAR(waves.power_at(kTurnMm, values), 1.0, 1e-9);
    const auto power = waves.power(values);
    const auto best = std::max_element(power.begin(), power.end()) - power.begin();
    // To the nearest period that is tried: an eighth of a wave over the span.
    const double span = waves.periods_mm().front();
    EXPECT_NEAR(span / waves.periods_mm()[static_cast<std::size_t>(best)], span / kTurnMm, 0.13)
        << "phase " << phase;
  }
}

TEST(Periodogram, DoesNotDependOnWhereLengthsAreCountedFrom) {
  const auto places = uneven_places(14, 30);
  auto moved = places;
  for (double& at : moved) at += 1000.0;
  const auto values = noise(14, 30);
  const auto here = Periodogram(places, kShortestMm).power(values);
  const auto there = Periodogram(moved, kShortestMm).power(values);
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t k = 0; k < here.size(); ++k) {
    EXPECT_NEAR(here[k], there[k], 1e-7);  // rounding of places of 4000 mm, 500 waves away
  }
}

TEST(Periodogram, ValuesThatAreAllAlikeHaveNoWave) {
  const auto places = uneven_places(15, 20);
  const std::vector<double> values(20, 0.3);
  EXPECT_THAT(Periodogram(places, kShortestMm).power(values), testing::Each(0.0));
}

// With two of n - 1 degrees of freedom the share of noise is a beta variable (Lomb 1976, Scargle 1982):
// it exceeds p with chance (1 - p)^((n - 3) / 2).
TEST(Periodogram, ChanceAtOnePeriodIsThatOfABetaVariable) {
  EXPECT_EQ(chance_at_one_period(0.0, 28), 1.0);
  EXPECT_NEAR(chance_at_one_period(0.3, 28), std::pow(0.7, 12.5), 1e-15);  // rounding
}

TEST(Periodogram, RefusesWhatIsNone) {
  EXPECT_THROW(Periodogram({1.0, 2.0, 3.0}, 0.5), std::invalid_argument);
  EXPECT_THROW(Periodogram({1.0, 1.0, 1.0, 1.0, 1.0}, 0.5), std::invalid_argument);
  EXPECT_THROW(Periodogram({1.0, 2.0, 3.0, 4.0, 5.0}, 0.0), std::invalid_argument);
  EXPECT_THROW(Periodogram({1.0, 2.0, 3.0, 4.0, 5.0}, 9.0), std::invalid_argument);
  const Periodogram waves({1.0, 2.0, 3.0, 4.0, 5.0}, 2.0);
  EXPECT_THROW((void)waves.power({1.0, 2.0}), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
