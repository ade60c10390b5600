// SPDX-License-Identifier: GPL-3.0-or-later
/// Anchors by the one estimator from belt lengths as an observation, against fit_belts: two ways to
/// one minimum.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/belts_fit.hpp"
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

/// Anchors and their sigmas with the same readings, from a centimetre beside.
void expect_the_same(const MeasuredBelts& measured, double tolerance_mm) {
  const auto fit = fit_belts(measured);
  ASSERT_TRUE(fit) << fit.error().sentence;
  belts::AnchorVector start = belts::anchors_of(fit->machine);
  start += (belts::AnchorVector() << 9.0, -11.0, -8.0, 10.0, 12.0).finished();
  const auto estimate = belts::estimate_anchors(measured, counting_of(*fit), start);
  ASSERT_TRUE(estimate) << estimate.error().sentence;
  EXPECT_TRUE(estimate->settled);
  for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(estimate->mechanism->values()[row], fit->coordinates[i].fitted_mm, tolerance_mm)
        << fit->coordinates[i].name;
    EXPECT_NEAR(
        std::sqrt(estimate->covariance(row, row)), fit->coordinates[i].sigma_mm, tolerance_mm)
        << fit->coordinates[i].name;
  }
  EXPECT_NEAR(estimate->noise_factor, fit->spread_mm, tolerance_mm);
}

// FrameSolver stops where a step lowers the cost by less than 1e-9 of itself.
constexpr double kToleranceMm = 1e-6;

TEST(OneEstimator, FindsTheAnchorsOfASimulatedFrameAndTheirSigmas) {
  for (const std::uint64_t seed : {41, 42, 43, 44}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    for (const auto lengths :
         {model::BeltLengths::belt, model::BeltLengths::belt_and_arm, model::BeltLengths::span})
      expect_the_same(simulate({.seed = seed, .lengths = lengths}).belts, kToleranceMm);
  }
}

TEST(OneEstimator, WithoutTheReadingsThatDoNotCount) {
  SimulatedBelts set = simulate({.seed = 11});
  set.belts.points[3].lengths_mm.tl += 44.0;
  set.belts.points[30].lengths_mm.br -= 44.0;
  set.belts.points[60].lengths_mm.tr += 150.0;
  set.belts.points[40].lengths_mm.tl += 60.0;
  set.belts.points[40].lengths_mm.bl += 35.0;
  expect_the_same(set.belts, kToleranceMm);
}

TEST(OneEstimator, FindsTheAnchorsOfAFile) {
  const auto read =
      files::read_belts(std::string(CHAINTRUE_FIXTURES) + "/belts/thirty_one_places.json");
  MeasuredBelts measured = read.belts;
  measured.distances.clear();
  expect_the_same(measured, kToleranceMm);
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
        files::parse_maslow4(files::read_whole_file(folder / set.file), set.file, options).belts,
        kToleranceMm);
  }
}

}  // namespace
}  // namespace chaintrue::grid
