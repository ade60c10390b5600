// SPDX-License-Identifier: GPL-3.0-or-later
// The floor that rounding sets to the noise of second visits.
#include "grid/map/noise_from_repeats.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "grid/statistics.hpp"

namespace chaintrue::grid {
namespace {

std::vector<double> rounded_readings(double step_mm, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> anywhere(-1200.0, 1200.0);
  std::vector<double> readings;
  for (int i = 0; i < 40; ++i) readings.push_back(std::round(anywhere(random) / step_mm) * step_mm);
  return readings;
}

TEST(Rounding, IsFoundFromTheReadingsDigits) {
  constexpr std::uint64_t kSeed = 53;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  for (const double step : {1.0, 0.5, 0.2, 0.1, 0.01, 0.001, 25.4 / 16, 25.4 / 32, 25.4 / 64})
    EXPECT_DOUBLE_EQ(rounding_sigma_mm(rounded_readings(step, kSeed)), step / std::sqrt(12.0))
        << step;
  EXPECT_EQ(rounding_sigma_mm(rounded_readings(1e-9, kSeed)), 0.0)
      << "readings with all their digits";
  EXPECT_EQ(rounding_sigma_mm(rounded_readings(50.0, kSeed)), 0.0) << "places that somebody chose";
  EXPECT_EQ(rounding_sigma_mm(rounded_readings(76.2, kSeed)), 0.0)
      << "a banner in steps of three inches";
  EXPECT_EQ(rounding_sigma_mm({1.0, 2.0, 3.0}), 0.0) << "too few to tell";
  EXPECT_EQ(rounding_sigma_mm({}), 0.0);
}

TEST(Rounding, MatchesTheReadings) {
  MeasuredGrid commanded, lengths;
  for (const double reading : rounded_readings(0.5, 1)) {
    commanded.points.push_back(
        {{reading, reading + 1.0}, std::nullopt, model::BedPoint{0.0, 0.0}, {}});
    lengths.points.push_back(
        {{100.0, 200.0}, model::ChainLengths{1500.0 + reading, 1501.0}, {}, {}});
  }
  EXPECT_GT(rounding_noise(commanded).position_mm, 0.1);
  EXPECT_EQ(rounding_noise(commanded).length_mm, 0.0);
  EXPECT_GT(rounding_noise(lengths).length_mm, 0.1);
  EXPECT_EQ(rounding_noise(lengths).position_mm, 0.0);
}

TEST(Rounding, IsALowerLimitOfStatedNoise) {
  MeasuredGrid grid;
  for (const double reading : rounded_readings(0.5, 1))
    grid.points.push_back({{reading, reading + 1.0}, std::nullopt, model::BedPoint{0.0, 0.0}, {}});
  const StatedNoise fine = not_below_rounding({0.01, 0.01, 7.0}, grid);
  EXPECT_EQ(fine.length_mm, 0.01) << "lengths that were paid out, not read";
  EXPECT_DOUBLE_EQ(fine.position_mm, 0.5 / std::sqrt(12.0));
  EXPECT_EQ(fine.dof, 7.0);
  EXPECT_EQ(not_below_rounding({0.01, 0.3, 7.0}, grid).position_mm, 0.3);
}

/// Repeats give the scatter, but never less than rounding.
TEST(RepeatScatter, IsNotBelowRounding) {
  const observation::PointNoise unit{1.0, 0.0};
  const auto found = [&](double apart_mm, double rounding_mm) {
    RepeatScatter scatter(unit, {rounding_mm, 0.0});
    for (int group = 0; group < 3; ++group) {
      for (const double sign : {-1.0, 1.0})
        scatter.add(Eigen::Vector2d::Constant(sign * 0.5 * apart_mm), Eigen::Matrix2d::Identity());
      scatter.end_group();
    }
    return scatter.noise();
  };
  EXPECT_FALSE(found(0.0, 0.0)) << "copies";
  EXPECT_DOUBLE_EQ(found(0.0, 0.3)->factor, 0.3);
  EXPECT_DOUBLE_EQ(found(0.0, 0.3)->dof, 6.0);
  // Two readings d apart scatter by d / sqrt(2).
  EXPECT_DOUBLE_EQ(found(2.0, 0.3)->factor, std::sqrt(2.0));
  EXPECT_FALSE(RepeatScatter(unit, unit).noise()) << "no repeats";
}

}  // namespace
}  // namespace chaintrue::grid
