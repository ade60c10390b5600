// SPDX-License-Identifier: GPL-3.0-or-later
// Maps on the causes that are found, against hidden machines (tests/lab/generator): an excerpt of the
// command road.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/map_file.hpp"
#include "sealed/judge/map_errors.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Cause;
using generator::Hidden;
using generator::Where;
using grid::diagnosis::CausesFit;
using grid::diagnosis::OfferedCause;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// A hidden machine with both maps of its readings.
struct Road {
  generator::SealedSet set;
  grid::JointFit plain;
  CausesFit own;
  double plain_mm() const { return map_errors(set, plain.map)->true_rms_mm; }
  double own_mm() const { return map_errors(set, own.fit.map)->true_rms_mm; }
};

Road road_of(std::vector<Hidden> hidden, int points, std::uint64_t seed, bool accept_class = false,
             generator::Order order = generator::Order::random) {
  generator::Recipe recipe;
  recipe.points = points;
  recipe.kind = hidden.empty() ? generator::Mix::nothing : generator::Mix::single;
  recipe.exactly = std::move(hidden);
  recipe.order = order;
  generator::SealedSet set = generator::draw_set(recipe, seed);
  const grid::Measured measured(grid::files::parse_grid(set.grid_text, "sealed.json").grid);
  grid::diagnosis::CausesFitOptions options;
  options.accept_class = accept_class;
  return {std::move(set), grid::joint_fit(measured).value(),
          grid::diagnosis::fit_with_causes(measured, options).value()};
}

/// The list of start with a zero that moves during the session.
generator::SealedSet set_of_start(const Hidden& hidden, std::uint64_t seed) {
  generator::Recipe recipe = recipe_of_start();
  recipe.exactly = {hidden};
  return generator::draw_set(recipe, seed);
}

TEST(Road, AnEventOfOneSessionIsRemovedFromThatSession) {
  const generator::SealedSet set = set_of_start({Cause::zero_shift, Where::left, 10.0, 17.0}, 2);
  const auto first = grid::files::parse_grid(set.grid_text, "first.json").grid;
  const auto second = grid::files::parse_grid(another_session(set, 5.0, 2), "second.json").grid;
  const auto fit = grid::diagnosis::fit_with_causes({{"first", first}, {"second", second}});
  ASSERT_TRUE(fit) << fit.error().sentence();
  ASSERT_THAT(fit->built_on, SizeIs(1)) << fit->not_weighed;
  EXPECT_EQ(fit->built_on.front().cause.effect->id, "zero_shift");
  ASSERT_TRUE(fit->fit.estimate.observations[1].zeros);
  const auto& zero = (*fit->fit.estimate.observations[1].zeros)[0];
  EXPECT_NEAR(zero.mm, 5.0, 4.0 * zero.sigma_mm);
  const auto errors = map_errors(set, fit->fit.map);
  ASSERT_TRUE(errors);
  EXPECT_LT(errors->true_rms_mm, 0.5) << "as of a session in which nothing happened";
}

TEST(Road, OnlyAShiftOfWholeLinksMayBeASkippedTooth) {
  const auto links = [](double count) { return 6.35 * count; };
  struct Case {
    Hidden hidden;
    const char* named;
    bool is_both;
  };
  for (const Case& own :
       {Case{{Cause::tooth_skip, Where::left, 1.0, 14.0}, "tooth_skip", true},
        Case{{Cause::zero_shift, Where::left, links(1.0), 14.0}, "tooth_skip", true},
        Case{{Cause::zero_shift, Where::right, links(-2.0), 12.0}, "tooth_skip", true},
        Case{{Cause::zero_shift, Where::left, links(1.5), 14.0}, "zero_shift", false},
        Case{{Cause::zero_shift, Where::right, -3.0, 17.0}, "zero_shift", false}}) {
    SCOPED_TRACE(fmt::format("{} {}", generator::card(own.hidden.cause).id, own.hidden.size));
    const auto session =
        grid::files::parse_grid(set_of_start(own.hidden, 3).grid_text, "sealed.json").grid;
    const auto found = grid::diagnosis::diagnose(session, verdict_alone()).value();
    ASSERT_THAT(found.causes, SizeIs(1)) << found.sentence;
    const auto& cause = found.causes.front();
    EXPECT_EQ(cause.cause.effect->id, own.named) << found.sentence;
    EXPECT_EQ(cause.same_as.size(), own.is_both ? 1U : 0U) << found.sentence;
    if (own.is_both && !cause.same_as.empty()) {
      const auto& same = cause.same_as.front();
      EXPECT_EQ(same.cause.effect->id, "zero_shift");
      const double mm =
          own.hidden.size * (own.hidden.cause == Cause::tooth_skip ? links(1.0) : 1.0);
      EXPECT_NEAR(same.parameters.front().value, mm, 4.0 * same.parameters.front().sigma);
    }
  }
}

std::string without_notes(const grid::CompensationMap& map) {
  grid::MapContents contents = map.contents();
  contents.notes.clear();
  return grid::files::write_map(grid::CompensationMap(std::move(contents)));
}

TEST(Road, ASoundMachineGetsThePlainMap) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Road road = road_of({}, 28, seed);
    EXPECT_THAT(road.own.built_on, IsEmpty()) << "seed " << seed;
    EXPECT_EQ(without_notes(road.own.fit.map), without_notes(road.plain.map)) << "seed " << seed;
    EXPECT_THAT(road.own.fit.map.contents().notes.size(),
                road.plain.map.contents().notes.size() + 1)
        << "the causes considered are reported";
  }
}

TEST(Road, AnUncorrectedCauseEntersTheExpectedError) {
  int open = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Road road =
        road_of({{Cause::drift, Where::both, 0.03, 0.0}}, 28, seed, false, generator::Order::rows);
    if (!road.own.built_on.empty() || road.own.left_open_mm == 0.0) continue;
    ++open;
    const double plain_mm = road.plain.map.contents().accuracy.expected_tool.rms_mm;
    const double own_mm = road.own.fit.map.contents().accuracy.expected_tool.rms_mm;
    // Same lengths, and variances that add; the map's file rounds nothing here.
    EXPECT_NEAR(std::hypot(plain_mm, road.own.left_open_mm), own_mm, 1e-9) << "seed " << seed;
    EXPECT_THAT(road.own.fit.map.contents().notes,
                ::testing::Contains(::testing::HasSubstr("to the expected error")));
  }
  EXPECT_GT(open, 0) << "drift looks like other causes where marks are visited in rows";
}

TEST(Road, APossibleTapeErrorIsOfferedForDecision) {
  const std::vector<Hidden> both = {{Cause::chain_pitch_error, Where::both, 0.002}};
  const Road asked = road_of(both, 60, 1);
  EXPECT_THAT(asked.own.built_on, IsEmpty());
  ASSERT_THAT(asked.own.offered, SizeIs(1));
  EXPECT_EQ(asked.own.offered.front().reason, OfferedCause::Reason::may_be_paper);
  EXPECT_THAT(grid::diagnosis::in_words(asked.own),
              ::testing::ElementsAre(::testing::HasSubstr("--accept-class")));
  // With the owner's yes it is judged by its gain, like any other.
  const Road accepted = road_of(both, 60, 1, true);
  for (const OfferedCause& offered : accepted.own.offered)
    EXPECT_EQ(offered.reason, OfferedCause::Reason::gains_nothing);
}

}  // namespace
}  // namespace chaintrue::sealed
