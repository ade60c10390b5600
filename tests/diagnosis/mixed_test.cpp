// SPDX-License-Identifier: GPL-3.0-or-later
// Points and distances of one machine in one estimate: together they identify what neither
// identifies alone.
#include <gmock/gmock.h>

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
  ASSERT_TRUE(found->improvement);
  EXPECT_LT(found->improvement->extended.rms_mm, found->improvement->calibrated.rms_mm);
  EXPECT_TRUE(found->stated_noise);
  EXPECT_TRUE(found->stated_tape);
}

TEST(TwoSessions, AnotherZeroIsReportedNotNamed) {
  const MeasuredGrid first = session_of({}, 21);
  MeasuredGrid second = session_of({}, 22);
  for (MeasuredPoint& point : second.points) point.lengths->left_mm += 5.0;
  const auto found = diagnose({{"first", first}, {"second", second}}, verdict_alone());
  ASSERT_TRUE(found) << found.error().sentence();
  EXPECT_EQ(found->verdict, Verdict::nothing_found) << found->sentence;
  EXPECT_THAT(found->notes,
              testing::Contains(testing::StartsWith(
                  "second: the chains' zeros differ from those in first: left chain ")));
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

TEST(MixedDiagnosis, FewOfEachAreEnoughTogether) {
  Measured measured(session_of({}, 1, 3, 2));
  measured.first_grid()->points.resize(5);
  EXPECT_FALSE(diagnose(measured, verdict_alone()));
  measured.add(holes_of({}, 2));
  EXPECT_TRUE(diagnose(measured, verdict_alone()));
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
