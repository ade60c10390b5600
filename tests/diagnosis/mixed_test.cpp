// SPDX-License-Identifier: GPL-3.0-or-later
// Points and distances of one machine in one estimate: together they identify what neither
// identifies alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/analysis.hpp"
#include "grid/synthetic/holes.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing_support::session_of;
using testing_support::verdict_alone;

MeasuredHoles design() {
  MeasuredHoles set;
  set.machine = model::Machine{};
  for (const double y : {-400.0, 0.0, 400.0}) {
    for (const double x : {-900.0, 0.0, 900.0}) {
      set.holes.push_back({std::string(1, static_cast<char>('A' + set.holes.size())), {x, y}});
    }
  }
  for (std::size_t i = 0; i < set.holes.size(); ++i) {
    for (std::size_t j = i + 1; j < set.holes.size(); j += 2) {
      set.distances.push_back({.from = i, .to = j});
    }
  }
  return set;
}

MeasuredHoles holes_of(const std::vector<model::AppliedEffect>& hidden, std::uint64_t seed) {
  return synthetic::simulate_holes(design(), {.hidden = hidden, .seed = seed})->set;
}

Measured mixed(const std::vector<model::AppliedEffect>& hidden, std::uint64_t seed) {
  Measured measured(session_of(hidden, seed, 4, 3));
  measured.add(holes_of(hidden, seed + 1000));
  return measured;
}

/// Log odds of the hidden cause's class against everything without it.
double log_odds(const Measured& measured, const CauseId& cause) {
  const auto a = analyse(observations_of(measured).value(), verdict_alone());
  double with = 0.0;
  double without = 0.0;
  for (const CandidateModel& model : a->comparison.models) {
    const bool acts = std::any_of(model.regressors.begin(), model.regressors.end(), [&](int k) {
      return a->system.regressors[static_cast<std::size_t>(k)].cause == cause;
    });
    (acts ? with : without) += a->comparison.probability(model);
  }
  return std::log(std::max(with, 1e-300)) - std::log(std::max(without, 1e-300));
}

TEST(MixedDiagnosis, TellsMoreThanEitherAlone) {
  const model::AppliedEffect hidden{"chain_pitch_error", "left", {{"elongation", 0.0006}}};
  const CauseId cause{model::effects::find_effect("chain_pitch_error"),
                      model::effects::EffectSide::left};
  constexpr int kSeeds = 12;
  int better_than_both = 0;
  double sum_mixed = 0.0;
  double sum_points = 0.0;
  double sum_distances = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Measured both = mixed({hidden}, seed);
    const double points = log_odds(*both.grids().front(), cause);
    const double distances = log_odds(*both.holes().front(), cause);
    const double mix = log_odds(both, cause);
    sum_points += points;
    sum_distances += distances;
    sum_mixed += mix;
    better_than_both += mix > std::max(points, distances) ? 1 : 0;
  }
  // Evidence adds up on average over the seeds; in one session noise may be against the cause.
  EXPECT_GT(sum_mixed, std::max(sum_points, sum_distances)) << "seeds 1 to " << kSeeds;
  EXPECT_GE(better_than_both, kSeeds / 2 + 1) << "of " << kSeeds;
}

TEST(MixedDiagnosis, FillsTheWholeAnswer) {
  const model::AppliedEffect hidden{"chain_pitch_error", "left", {{"elongation", 0.0015}}};
  Measured measured(session_of({hidden}, 3));
  measured.add(holes_of({hidden}, 4));
  const auto found = diagnose(measured);
  ASSERT_TRUE(found) << found.error().sentence();
  EXPECT_EQ(found->observations, Observations::both);
  EXPECT_EQ(found->verdict, Verdict::named) << found->sentence;
  EXPECT_EQ(found->causes.front().cause.effect->id, "chain_pitch_error");
  EXPECT_EQ(found->points.size(), measured.grids().front()->points.size());
  EXPECT_EQ(found->distances.size(), measured.holes().front()->distances.size());
  EXPECT_EQ(found->holes.size(), measured.holes().front()->holes.size());
  ASSERT_TRUE(found->stability);
  int distances = 0;
  int holes = 0;
  for (const Removal& removal : found->stability->removals) {
    distances += removal.what == Removal::What::distance ? 1 : 0;
    holes += removal.what == Removal::What::hole ? 1 : 0;
  }
  EXPECT_EQ(distances, static_cast<int>(found->distances.size()));
  EXPECT_EQ(holes, static_cast<int>(found->holes.size()));
  ASSERT_TRUE(found->normal_plot);
  EXPECT_EQ(found->normal_plot->values.size(),
            2 * found->points.size() + found->distances.size());
  ASSERT_TRUE(found->improvement);
  EXPECT_LT(found->improvement->extended.rms_mm, found->improvement->calibrated.rms_mm);
  EXPECT_TRUE(found->stated_noise);
  EXPECT_TRUE(found->stated_tape);
}

TEST(TwoSessions, AnotherZeroIsNoCauseAndIsTold) {
  const MeasuredGrid first = session_of({}, 21);
  MeasuredGrid second = session_of({}, 22);
  for (MeasuredPoint& point : second.points) point.lengths->left_mm += 5.0;
  const auto found = diagnose({{"first", first}, {"second", second}}, verdict_alone());
  ASSERT_TRUE(found) << found.error().sentence();
  EXPECT_EQ(found->verdict, Verdict::nothing_found) << found->sentence;
  EXPECT_THAT(found->notes,
              testing::Contains(testing::StartsWith(
                  "second: the chains' zeros are other than in first: left chain ")));
  const auto same = diagnose({{"first", first}, {"second", session_of({}, 22)}}, verdict_alone());
  ASSERT_TRUE(same);
  EXPECT_THAT(same->notes, testing::Not(testing::Contains(testing::HasSubstr("zeros"))));
}

TEST(MixedDiagnosis, ABadReadingOfEitherKindIsFound) {
  Measured measured(session_of({}, 5));
  measured.first_grid()->points[4].lengths->left_mm += 9.0;
  MeasuredHoles set = holes_of({}, 6);
  set.distances[7].distance_mm += 15.0;
  measured.add(set);
  const auto found = diagnose(measured, verdict_alone());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->outliers.size(), 2u) << found->sentence;
  EXPECT_EQ(found->outliers[0].of, Observations::points);
  EXPECT_EQ(found->outliers[0].index, 4u);
  EXPECT_EQ(found->outliers[1].of, Observations::distances);
  EXPECT_EQ(found->outliers[1].index, 7u);
}

// The result is independent of the order of files of different kinds, and of the order in them.
TEST(MixedDiagnosis, TheOrderOfTheFilesChangesNothing) {
  const model::AppliedEffect hidden{"beam_flex", "", {{"flexibility_mm_per_n", 0.02}}};
  const MeasuredGrid grid = session_of({hidden}, 9, 5, 3);
  MeasuredHoles set = holes_of({hidden}, 10);
  Measured one(grid);
  one.add(set);
  std::reverse(set.distances.begin(), set.distances.end());
  Measured other(set);
  other.add(grid);
  const auto a = diagnose(one, verdict_alone());
  const auto b = diagnose(other, verdict_alone());
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->sentence, b->sentence);
  ASSERT_EQ(a->hypotheses.size(), b->hypotheses.size());
  for (std::size_t k = 0; k < a->hypotheses.size(); ++k) {
    EXPECT_EQ(a->hypotheses[k].probability, b->hypotheses[k].probability);
  }
}

TEST(MixedDiagnosis, FewOfEachAreEnoughTogether) {
  Measured measured(session_of({}, 1, 3, 2));
  measured.first_grid()->points.resize(5);
  EXPECT_FALSE(diagnose(measured, verdict_alone()));
  measured.add(holes_of({}, 2));
  EXPECT_TRUE(diagnose(measured, verdict_alone()));
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
