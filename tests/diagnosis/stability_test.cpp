// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a name depends on a few points: downdated comparisons checked against full ones, a stable
// name, and one that depends on a single point.
#include "grid/diagnosis/stability.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/downdating.hpp"
#include "grid/synthetic/generator.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing_support::analysis_of;
using testing_support::session_of;
using testing_support::verdict_alone;

const model::AppliedEffect kLongLeftChain{"chain_pitch_error", "left", {{"elongation", 0.0015}}};

std::size_t count(const Stability& stability, Removal::What what) {
  return static_cast<std::size_t>(std::count_if(stability.removals.begin(),
                                                stability.removals.end(),
                                                [&](const Removal& r) { return r.what == what; }));
}

double probability_that_all_act(const Analysis& a, const ModelComparison& comparison) {
  double p = 0.0;
  for (const CandidateModel& model : comparison.models) {
    const bool all =
        std::all_of(a.decision.listed.begin(), a.decision.listed.end(), [&](std::size_t index) {
          const CauseClass& members = a.decision.classes[index];
          return std::any_of(model.regressors.begin(), model.regressors.end(), [&](int k) {
            return std::find(members.begin(), members.end(), regressor(a, k).cause) !=
                   members.end();
          });
        });
    if (all) p += comparison.probability(model);
  }
  return p;
}

TEST(LeavingOut, ColumnsAndRowsHoldEveryPointOnce) {
  const auto session = observations_of(session_of({}, 1));
  ASSERT_TRUE(session);
  const auto groups = groups_to_leave_out(*session);
  for (const auto& [what, lines] :
       {std::pair(Removal::What::column, 7), std::pair(Removal::What::row, 4)}) {
    std::vector<int> times(session->units.size(), 0);
    int found = 0;
    for (const LeftOut& group : groups) {
      if (group.what != what) continue;
      ++found;
      for (const std::size_t i : group.units) ++times[i];
    }
    EXPECT_EQ(found, lines);
    EXPECT_THAT(times, testing::Each(1));
  }
}

TEST(LeavingOut, MarksThatLieAnywhereHaveNoColumns) {
  synthetic::SyntheticSpec spec;
  spec.design.kind = synthetic::DesignKind::random;
  spec.design.points = 30;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
  const auto session = observations_of(synthetic::generate(model::Machine{}, spec).value().grid);
  ASSERT_TRUE(session);
  for (const LeftOut& group : groups_to_leave_out(*session)) {
    EXPECT_EQ(group.what, Removal::What::point);
  }
}

// Nothing left out: the comparison itself, except for models that are not followed.
TEST(Downdating, WithAllPointsEqualsTheComparison) {
  const Analysis a = analysis_of(session_of({kLongLeftChain}, 3));
  ASSERT_FALSE(a.decision.listed.empty());
  const auto all = Downdating(a.system, a.comparison).without({});
  EXPECT_LT(a.null.p_value(all.score), kFalseAlarm);
  EXPECT_EQ(all.comparison.best().regressors, a.comparison.best().regressors);
  // Two factorisations of one matrix.
  EXPECT_NEAR(all.comparison.best().log_weight, a.comparison.best().log_weight, 1e-6);
  EXPECT_NEAR(probability_that_all_act(a, all.comparison),
              probability_that_all_act(a, a.comparison),
              0.01);  // total of discrepancies below a hundredth
}

// Downdating compared with a separate comparison without each point and line.
TEST(Downdating, EqualsANewComparison) {
  const model::AppliedEffect wave{
      "sprocket_eccentricity", "left", {{"amplitude_mm", 0.6}, {"phase_rad", 1.0}}};
  for (const auto& [hidden, seed] : {std::pair(wave, 1), std::pair(kLongLeftChain, 2)}) {
    SCOPED_TRACE(hidden.effect);
    const auto session = observations_of(session_of({hidden}, static_cast<std::uint64_t>(seed)));
    const auto a = analyse(*session, verdict_alone());
    ASSERT_TRUE(a);
    ASSERT_EQ(a->decision.verdict, Verdict::named);
    const auto stability = examine_stability(*a);
    ASSERT_TRUE(stability);
    const auto groups = groups_to_leave_out(*session);
    ASSERT_EQ(stability->removals.size(), groups.size());
    for (std::size_t k = 0; k < groups.size(); k += 3) {
      std::vector<bool> excluded(session->units.size(), false);
      for (const std::size_t i : groups[k].units) excluded[i] = true;
      const ModelComparison comparison = compare_models(a->system, excluded, {});
      const Decision decision = decide(a->system, comparison, excluded, true, a->decision.classes);
      EXPECT_EQ(stability->removals[k].stands, still_named(a->decision, decision)) << "group " << k;
      // Not included in the models of all points: sets of outliers and discrepancies that become
      // relevant only without these points.
      EXPECT_NEAR(stability->removals[k].probability, probability_that_all_act(*a, comparison), 0.1)
          << "group " << k;
    }
  }
}

TEST(Stability, AStrongNameSurvivesWithoutAnyPointColumnOrRow) {
  const auto found = diagnose(session_of({kLongLeftChain}, 5), verdict_alone());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->verdict, Verdict::named) << found->sentence;
  ASSERT_TRUE(found->stability);
  const Stability& stability = *found->stability;
  EXPECT_EQ(count(stability, Removal::What::point), found->points.size());
  EXPECT_EQ(count(stability, Removal::What::column), 7U);
  EXPECT_EQ(count(stability, Removal::What::row), 4U);
  for (const Removal& removal : stability.removals) {
    EXPECT_TRUE(removal.stands);
    EXPECT_GT(removal.probability, 0.9);
  }
  EXPECT_THAT(found->not_proved, Not(HasSubstr("rests on")));
  EXPECT_THAT(found->notes, testing::Contains(HasSubstr("Leaving out any of")));
}

TEST(Stability, IsAbsentWithoutAName) {
  const auto found = diagnose(session_of({}, 7), verdict_alone());
  ASSERT_TRUE(found);
  ASSERT_TRUE(found->causes.empty()) << found->sentence;
  EXPECT_FALSE(found->stability);
}

// One reading off by two millimetres, in a corner where a bent chain would have the same signature:
// an effect of one point is not named.
TEST(Stability, OnePointDecidesNoName) {
  int refused = 0;
  for (const auto& [seed, point, residual_mm] :
       {std::tuple(1U, 21U, 2.0), std::tuple(1U, 21U, 1.5), std::tuple(2U, 27U, -3.0),
        std::tuple(2U, 27U, -2.0)}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", point " << point + 1);
    MeasuredGrid grid = session_of({}, seed);
    grid.points[point].lengths->right_mm += residual_mm;
    const auto found = diagnose(grid, verdict_alone());
    ASSERT_TRUE(found);
    EXPECT_NE(found->verdict, Verdict::named) << found->sentence;
    if (found->notes.empty() || found->notes.front().find("suggests a cause") == std::string::npos)
      continue;
    ++refused;
    EXPECT_EQ(found->verdict, Verdict::outliers) << found->sentence;
    EXPECT_TRUE(found->causes.empty());
    EXPECT_THAT(found->notes.front(), HasSubstr(fmt::format("Point {} alone", point + 1)));
    ASSERT_EQ(found->outliers.size(), 1u);
    EXPECT_EQ(found->outliers.front().index, point);
    EXPECT_TRUE(found->extended_machine.effects.empty());
  }
  EXPECT_GT(refused, 0) << "no reading makes a name any more: choose others";
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
