// SPDX-License-Identifier: GPL-3.0-or-later
/// Anchors estimated by the general estimator with belt lengths as an observation, compared with
/// fit_belts: two methods for the same minimum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/settled_frame.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "tests/belts/simulated_belts.hpp"

namespace chaintrue::grid {
namespace {

belts::Counting counting_of(const BeltsFit& fit) {
  belts::Counting counting;
  for (const FittedPlace& place : fit.places) {
    model::PerBelt<bool> counts;
    for (const model::Belt belt : model::kBelts) counts[belt] = place.belts[belt].counts;
    counting.push_back(counts);
  }
  return counting;
}

/// AnchorAdjustment stops when a step lowers the cost by less than 1e-9 of itself: for readings of real
/// machines some 1e-5 mm before the minimum. Restarted it takes at least one more step.
belts::AnchorFit at_the_minimum(const MeasuredBelts& measured,
                                const BeltsFit& fit,
                                const belts::Counting& counting) {
  belts::FrameState state;
  state.anchors = belts::anchors_of(fit.machine);
  for (const FittedPlace& place : fit.places) state.places.push_back(place.at);
  std::optional<belts::AnchorFit> frame;
  for (int again = 0; again < 4; ++again) {
    frame = belts::settle_from(measured, state, counting);
    state = frame.value().state;
  }
  return *frame;
}

/// The same minimum by two methods: rounding of sums of some hundred readings of metres.
constexpr double kSameMinimumMm = 1e-6;
/// Distance from the minimum at which AnchorAdjustment stops, see above.
constexpr double kStopsBeforeMm = 2e-5;

/// Compares anchors, their sigmas and the noise for the readings that fit_belts uses, starting a
/// centimetre from the solution.
void expect_the_same(const MeasuredBelts& measured) {
  const auto fit = fit_belts(measured);
  ASSERT_TRUE(fit) << fit.error().sentence;
  const belts::Counting counting = counting_of(*fit);
  const belts::AnchorFit frame = at_the_minimum(measured, *fit, counting);
  belts::AnchorVector start = belts::anchors_of(fit->machine);
  start += (belts::AnchorVector() << 9.0, -11.0, -8.0, 10.0, 12.0).finished();
  const auto estimate = belts::estimate_anchors(measured, counting, start);
  ASSERT_TRUE(estimate) << estimate.error().sentence;
  EXPECT_TRUE(estimate->settled);
  const belts::FitDiagnostics view(measured, frame);
  for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    SCOPED_TRACE(fit->coordinates[i].name);
    const double found = estimate->mechanism->values()[row];
    const double sigma = std::sqrt(estimate->covariance(row, row));
    // Iterations end at 1e-6 of a sigma: for six positions that is more than 1e-6 mm.
    const double tolerance_mm = kSameMinimumMm * std::max(1.0, sigma);
    EXPECT_NEAR(found, frame.state.anchors[row], tolerance_mm);
    EXPECT_NEAR(sigma, std::sqrt(view.covariance()(row, row)), tolerance_mm);
    EXPECT_NEAR(found, fit->coordinates[i].fitted_mm, kStopsBeforeMm);
    EXPECT_NEAR(sigma, fit->coordinates[i].sigma_mm, kStopsBeforeMm);
  }
  EXPECT_NEAR(estimate->noise_factor, fit->spread_mm, kSameMinimumMm);
}

TEST(OneEstimator, FindsTheAnchorsOfASimulatedFrameAndTheirSigmas) {
  for (const std::uint64_t seed : {41, 42, 43, 44}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    for (const auto lengths :
         {model::BeltLengths::belt, model::BeltLengths::belt_and_arm, model::BeltLengths::span})
      expect_the_same(simulate({.seed = seed, .lengths = lengths}).belts);
  }
}

TEST(OneEstimator, WithoutTheReadingsThatDoNotCount) {
  SimulatedBelts set = simulate({.seed = 11});
  set.belts.points[3].lengths_mm.tl += 44.0;
  set.belts.points[30].lengths_mm.br -= 44.0;
  set.belts.points[60].lengths_mm.tr += 150.0;
  set.belts.points[40].lengths_mm.tl += 60.0;
  set.belts.points[40].lengths_mm.bl += 35.0;
  expect_the_same(set.belts);
}

TEST(OneEstimator, FindsTheAnchorsOfAFile) {
  const auto read =
      files::read_belts(std::string(CHAINTRUE_FIXTURES) + "/belts/thirty_one_places.json");
  MeasuredBelts measured = read.belts;
  measured.distances.clear();
  expect_the_same(measured);
}

TEST(OneEstimator, FindsTheAnchorsOfRealMachines) {
  const std::filesystem::path folder = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the readings are not with this checkout";
  struct Set {
    const char* file;
    int run;
  };
  for (const Set& set : {Set{"concrete_anchors.txt", 1},
                         Set{"frame_rebuilt.txt", 1},
                         Set{"mini_frame.txt", 1},
                         Set{"ten_runs_1_to_5.txt", 1},
                         Set{"ten_runs_1_to_5.txt", 5},
                         Set{"clbm_2026-01.txt", 1}}) {
    SCOPED_TRACE(set.file);
    files::Maslow4Options options;
    options.run = set.run;
    expect_the_same(
        files::parse_maslow4(files::read_whole_file(folder / set.file), set.file, options).belts);
  }
}

// fit_belts rejects a reading and keeps the other three of its position; the estimator's own loop
// rejects the position, whose two rows are one outlier group, and reduces the weight of residuals
// beyond 95 %.
TEST(OneEstimator, RejectsByItselfThePlacesOfWhichFitBeltsRejectsAReading) {
  for (const std::uint64_t seed : {11, 12}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    SimulatedBelts set = simulate({.seed = seed});
    set.belts.points[3].lengths_mm.tl += 44.0;
    set.belts.points[30].lengths_mm.br -= 44.0;
    set.belts.points[31].lengths_mm.br -= 12.0;
    set.belts.points[60].lengths_mm.tr += 150.0;
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit);
    const belts::Counting all(set.belts.points.size(), {true, true, true, true});
    estimation::EstimationInput input =
        belts::anchor_input(set.belts, all, belts::anchors_of(fit->machine));
    input.fixed_weights.reset();
    const auto estimate = estimation::estimate(input);
    ASSERT_TRUE(estimate && estimate->settled);
    std::vector<std::size_t> rejected;
    for (const estimation::UnitEstimate& unit : estimate->units) {
      if (unit.is_rejected())
        rejected.push_back(input.observations.front()->units()[unit.unit].index);
    }
    EXPECT_EQ(rejected, (std::vector<std::size_t>{3, 30, 31, 60}));
    for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
      // Twelve readings fewer of 324, and a few other weights: 0.2 of a sigma in both sets.
      EXPECT_NEAR(estimate->mechanism->values()[static_cast<Eigen::Index>(i)],
                  fit->coordinates[i].fitted_mm,
                  0.5 * fit->coordinates[i].sigma_mm);
    }
  }
}

}  // namespace
}  // namespace chaintrue::grid
