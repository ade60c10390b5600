// SPDX-License-Identifier: GPL-3.0-or-later
// Anchors fitted once, and positions measured later: unchanged frames are reported valid, shifted
// zeros with their belt and size, an anchor that moved is found; one bad reading does not affect
// the verdict on the anchors.
#include "grid/belts/anchors_check.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "grid/synthetic/simulated_belts.hpp"
#include "tests/belts/frame.hpp"

namespace chaintrue::grid {
namespace {

using model::Belt;
using testing::HasSubstr;

constexpr int kFrames = 30;
constexpr double kNoiseMm = 0.5;

MeasuredBelts measured(const model::BeltMachine& truth, int columns, int rows, std::uint64_t seed) {
  synthetic::BeltsSpec spec;
  spec.columns = columns;
  spec.rows = rows;
  spec.width_share = 0.6;
  spec.height_share = 0.5;
  spec.noise_mm = kNoiseMm;
  spec.seed = seed;
  return synthetic::simulate_belts(testing_support::stated(), truth, spec).value();
}

/// Checks of six new places, for frames 1 to kFrames, that something has happened to.
std::vector<Check> checks(const std::function<void(model::BeltMachine&)>& to_frame,
                                 const std::function<void(MeasuredBelts&)>& to_readings) {
  std::vector<Check> result;
  for (std::uint64_t seed = 1; seed <= kFrames; ++seed) {
    const auto fit = fit_belts(measured(testing_support::truth(), 6, 6, seed));
    model::BeltMachine now = testing_support::truth();
    to_frame(now);
    MeasuredBelts belts = measured(now, 3, 2, 500 + seed);
    to_readings(belts);
    result.push_back(check_anchors(*fit, belts).value());
  }
  return result;
}

const auto kNothing = [](auto&) {};

TEST(AnchorsCheck, AFrameThatIsAsItWasIsStillValid) {
  int valid = 0;
  for (const Check& check : checks(kNothing, kNothing)) {
    valid += check.is_valid_as_it_is();
    // The probabilities of all outcomes are reported.
    EXPECT_NEAR(check.probability[0] + check.probability[1] + check.probability[2], 1.0, 1e-9);
  }
  // "Decided" is 80 %: one in ten may be missed, and four misses of thirty occur once in ten such
  // runs.
  EXPECT_GE(valid, kFrames - 5) << "frames 1 to " << kFrames;
}

TEST(AnchorsCheck, ABeltThatCountsFromElsewhereIsNamedWithItsSize) {
  const auto shifted = [](MeasuredBelts& belts) {
    for (BeltPoint& point : belts.points) point.lengths_mm.br += 6.0;
  };
  int named = 0;
  for (const Check& check : checks(kNothing, shifted)) {
    const CheckHypothesis& first = check.hypotheses.front();
    EXPECT_FALSE(check.is_valid_as_it_is());
    if (first.what != model::Change::zero || first.side != "br") continue;
    ++named;
    // Six places of which each leaves br some half of its noise, and the anchors' own doubt.
    EXPECT_NEAR(first.size(), 6.0, 4.0 * kNoiseMm);
    EXPECT_THAT(check.sentence, HasSubstr("drawn in and let out anew"));
  }
  EXPECT_GE(named, kFrames - 3) << "frames 1 to " << kFrames;
}

TEST(AnchorsCheck, AnAnchorThatMovedIsNotCalledValid) {
  int again = 0;
  const auto moved = [](model::BeltMachine& machine) { machine.anchors.tr.x_mm += 12.0; };
  for (const Check& check : checks(moved, kNothing)) {
    EXPECT_FALSE(check.is_valid_as_it_is()) << check.sentence;
    again += check.verdict == CheckVerdict::measure_again;
  }
  // A shifted zero of a belt has a similar signature at six positions.
  EXPECT_GT(again, kFrames / 2) << "frames 1 to " << kFrames;
}

TEST(AnchorsCheck, OneBadReadingIsNamedByItsPointAndSaysNothingOfTheAnchors) {
  const auto spoilt = [](MeasuredBelts& belts) { belts.points[4].lengths_mm.tl += 20.0; };
  for (const Check& check : checks(kNothing, spoilt)) {
    EXPECT_EQ(check.hypotheses.front().what, model::Change::bad_point) << check.sentence;
    EXPECT_EQ(check.hypotheses.front().count, 4);
    EXPECT_THAT(check.sentence, HasSubstr("Measure point 5 again"));
  }
}

TEST(AnchorsCheck, WhatCannotBeCheckedHasASentence) {
  const auto fit = fit_belts(measured(testing_support::truth(), 6, 6, 1));
  MeasuredBelts inches = measured(testing_support::truth(), 3, 2, 2);
  for (BeltPoint& point : inches.points) {
    for (const Belt belt : model::kBelts) point.lengths_mm[belt] /= 25.4;
  }
  const auto nowhere = check_anchors(*fit, inches);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().reason, CheckFailure::Reason::nowhere);
  BeltsFit of_holes = *fit;
  of_holes.checks = 0;
  EXPECT_EQ(check_anchors(of_holes, inches).error().reason, CheckFailure::Reason::no_noise);
}

}  // namespace
}  // namespace chaintrue::grid
