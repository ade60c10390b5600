// SPDX-License-Identifier: GPL-3.0-or-later
// Waves along a chain: laws of the periodogram, and its level compared with noise.
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

// Noise passes the level in one of a hundred sessions, as stated.
TEST(Periodogram, NoisePassesTheLevelAsOftenAsItSays) {
  const auto places = uneven_places(16, 34);
  const Periodogram waves(places, kShortestMm);
  const double level = waves.level(0.01, 999, 1);
  constexpr int kSessions = 2000;
  int above = 0;
  for (int session = 0; session < kSessions; ++session) {
    const auto power = waves.power(noise(5000 + static_cast<std::uint64_t>(session), 34));
    if (*std::max_element(power.begin(), power.end()) > level) ++above;
  }
  // 20 expected; the level itself is the tenth largest of 999 draws, so that its chance is 1 %
  // within a third: 20 +- sqrt(20 + 6.3^2), three sigma.
  EXPECT_GE(above, 1);
  EXPECT_LE(above, 43);
}

TEST(Periodogram, ChanceAtOnePeriodIsUniformForNoise) {
  const auto places = uneven_places(17, 28);
  const Periodogram waves(places, kShortestMm);
  constexpr int kSessions = 4000;
  std::vector<double> chances;
  for (int session = 0; session < kSessions; ++session) {
    const auto values = noise(9000 + static_cast<std::uint64_t>(session), 28);
    chances.push_back(chance_at_one_period(waves.power_at(kTurnMm, values), 28));
  }
  std::sort(chances.begin(), chances.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < chances.size(); ++i) {
    distance =
        std::max(distance, std::abs(chances[i] - (static_cast<double>(i) + 0.5) / kSessions));
  }
  // Kolmogorov's distance, 1 in 1000: 1.95 / sqrt(n).
  EXPECT_LT(distance, 1.95 / std::sqrt(kSessions));
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
