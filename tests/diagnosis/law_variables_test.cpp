// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Variables and entries of laws: for four belts a law's columns are the difference of readings
/// with the law; short waves that evenly spaced marks alias are not tried; a step in one chain's
/// variable lies between that chain's readings.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/law_curves.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/random.hpp"
#include "tests/diagnosis/law_sessions.hpp"

namespace chaintrue::grid::diagnosis::law_places {
namespace {

using model::Belt;

MeasuredBelts frame() {
  return files::read(files::parse_belts, CHAINTRUE_FIXTURES "/belts/thirty_one_places.json").belts;
}

// For every variable, belt by belt: the residuals of the readings with the law, less those without.
TEST(BeltLaws, ColumnsAreTheDifferencesOfReadings) {
  const MeasuredBelts plain = frame();
  const belts::FrameState state = belts::fit_anchors_robustly(plain).value().state;
  constexpr double kSigmaMm = 0.4;
  const RegressorSystem system = system_of(plain, state, observations_of(plain, state, kSigmaMm));
  int compared = 0;
  for (const Coordinate of : law_variables(system)) {
    for (const LawEntrance& entrance : law_entrances(system, of)) {
      const Belt belt = belt_of(entrance.enters).value();
      MeasuredBelts with = plain;
      Eigen::VectorXd column = Eigen::VectorXd::Zero(system.e.size());
      for (std::size_t u = 0; u < system.units.size(); ++u) {
        const std::vector<LawRows> rows = law_rows(system, u, {of, entrance.enters, 0.0});
        ASSERT_EQ(rows.size(), 1U);
        const double value_mm = 0.3 * std::sin(0.01 * rows.front().v);
        with.points[system.places[u].place].lengths_mm[belt] += value_mm;
        column.segment(system.units[u].first_row, 2) = value_mm * rows.front().rows;
      }
      const RegressorSystem read = system_of(with, state, observations_of(with, state, kSigmaMm));
      // Residuals are linear in the readings: rounding of lengths of some metres.
      EXPECT_LT((read.e - system.e - column).norm(), 1e-9)
          << name(of) << " " << name(entrance.enters);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 11 * 4);
}

TEST(BeltLaws, PriorIsSharedAmongEntrancesOfAVariable) {
  const MeasuredBelts belts = frame();
  const belts::FrameState state = belts::fit_anchors_robustly(belts).value().state;
  const RegressorSystem system = system_of(belts, state, observations_of(belts, state, 0.4));
  for (const Coordinate of : law_variables(system)) {
    double sum = 0.0;
    const LawEntrance* most = nullptr;
    const std::vector<LawEntrance> entrances = law_entrances(system, of);
    for (const LawEntrance& own : entrances) {
      sum += own.weight;
      if (most == nullptr || own.weight > most->weight) most = &own;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12) << name(of);
    if (belt_of(of)) {
      EXPECT_EQ(belt_of(most->enters), belt_of(of)) << name(of);
    }
  }
}

/// Waves over the span of the shortest one tried.
double most_waves(const RegressorSystem& system, Coordinate of, LawShape shape) {
  double most = 0.0;
  for (const LawCurve& curve : law_curves(system)) {
    if (curve.of == of && curve.shape == shape) most = std::max(most, curve.grid.back());
  }
  return most;
}

// Nine columns: eight gaps; a wave needs at least two (the sampling theorem); its second harmonic
// as well. The lengths of a chain are not evenly spaced.
TEST(WavesOverEvenlySpacedMarks, AreNoShorterThanTwoColumns) {
  MeasuredGrid grid = testing_support::session_of({}, 5, 9, 6);
  const RegressorSystem even = laws::analysed(grid).system;
  // Half a quarter of a wave: the grid of waves; marks are within a few millimetres of their columns.
  EXPECT_NEAR(most_waves(even, Coordinate::x, LawShape::wave), 4.0, 0.26);
  EXPECT_NEAR(most_waves(even, Coordinate::x, LawShape::harmonics), 2.0, 0.13);
  EXPECT_NEAR(most_waves(even, Coordinate::y, LawShape::wave), 2.5, 0.26);
  EXPECT_GT(most_waves(even, Coordinate::length_left, LawShape::wave), 40.0);
  // Scattered marks resolve short waves too.
  constexpr std::uint64_t kSeed = 7;
  Random random(kSeed);
  for (MeasuredPoint& point : grid.points) {
    point.mark.x_mm += 90.0 * (random.uniform() - 0.5);
    point.mark.y_mm += 90.0 * (random.uniform() - 0.5);
  }
  const RegressorSystem anywhere = laws::analysed(grid).system;
  EXPECT_GT(most_waves(anywhere, Coordinate::x, LawShape::wave), 8.0) << "seed " << kSeed;
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis::law_places
