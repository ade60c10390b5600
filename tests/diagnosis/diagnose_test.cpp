// SPDX-License-Identifier: GPL-3.0-or-later
// Bad input with its messages, and laws of a diagnosis on generated sessions.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/synthetic/generator.hpp"
#include "grid/synthetic/strength.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing::HasSubstr;
using testing_support::session_of;
using testing_support::verdict_alone;

void expect_refused(const MeasuredGrid& grid, DiagnosisFailure::Reason reason,
                    const std::string& words) {
  const auto answer = diagnose(grid, verdict_alone());
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().reason, reason);
  EXPECT_THAT(answer.error().sentence(), HasSubstr(words));
}

TEST(DiagnoseBadInput, RefusesTooFewPoints) {
  MeasuredGrid grid = session_of({}, 1);
  grid.points.resize(7);
  expect_refused(grid, DiagnosisFailure::Reason::too_few_points, "7 points are too few");
}

TEST(DiagnoseBadInput, RefusesMissingNoiseWithoutRepeats) {
  MeasuredGrid grid = session_of({}, 1);
  grid.noise.reset();
  grid.points.resize(20);
  std::erase_if(grid.points, [&](const MeasuredPoint& p) {
    return std::count_if(grid.points.begin(), grid.points.end(), [&](const MeasuredPoint& q) {
             return std::hypot(p.mark.x_mm - q.mark.x_mm, p.mark.y_mm - q.mark.y_mm) < 25.0;
           }) > 1;
  });
  expect_refused(grid, DiagnosisFailure::Reason::no_noise, "measure at least six points twice");
}

TEST(DiagnoseBadInput, EstimatesMissingNoiseFromRepeats) {
  MeasuredGrid grid = session_of({}, 2);
  grid.noise.reset();
  const auto answer = diagnose(grid, {});
  ASSERT_TRUE(answer);
  EXPECT_THAT(answer->notes, testing::Contains(HasSubstr("judged by the marks measured twice")));
}

TEST(DiagnoseBadInput, RefusesAMissingMachine) {
  MeasuredGrid grid = session_of({}, 1);
  grid.machine.reset();
  expect_refused(grid, DiagnosisFailure::Reason::no_machine, "--machine");
}

TEST(DiagnoseBadInput, ReportsAReadingThatContradictsTheMachine) {
  MeasuredGrid grid = session_of({}, 1);
  grid.readings.push_back({ReadingOf::motor_spacing, "", 2900.0, 1.0});
  expect_refused(grid, DiagnosisFailure::Reason::contradictory_settings,
                 "motor_spacing_mm is 2900, but the machine file has 2978.4");
}

TEST(DiagnoseBadInput, ReportsTwoContradictoryReadings) {
  MeasuredGrid grid = session_of({}, 1);
  grid.readings.push_back({ReadingOf::link_pitch, "left", 6.350, 0.001});
  grid.readings.push_back({ReadingOf::link_pitch, "left", 6.370, 0.001});
  expect_refused(grid, DiagnosisFailure::Reason::contradictory_settings,
                 "two readings of link_pitch_mm contradict each other");
}

TEST(DiagnoseBadInput, SuspectsListsOfOtherUnitsSidesOrMachines) {
  const std::pair<void (*)(MeasuredPoint&), const char*> slips[] = {
      {[](MeasuredPoint& p) { std::swap(p.lengths->left_mm, p.lengths->right_mm); },
       "the columns left_mm and right_mm look swapped"},
      {[](MeasuredPoint& p) {
         p.lengths = model::ChainLengths{p.lengths->left_mm / 25.4, p.lengths->right_mm / 25.4};
       },
       "look like inches"},
      {[](MeasuredPoint& p) { p.mark.y_mm *= -1.0; }, "y_mm looks counted downwards"},
      // The right chain of another machine: the calibration does not converge to a valid machine.
      {[](MeasuredPoint& p) { p.lengths->right_mm = 5000.0 - p.lengths->right_mm; },
       "are they from another sheet, another list or another machine?"}};
  for (const auto& [slip, words] : slips) {
    SCOPED_TRACE(words);
    MeasuredGrid grid = session_of({}, 3);
    for (MeasuredPoint& point : grid.points) slip(point);
    expect_refused(grid, DiagnosisFailure::Reason::contradictory_settings, words);
  }
}

/// Every effect, at a strength that identifies it, is named with its size within four sigma.
class EveryEffect : public testing::TestWithParam<const model::effects::Effect*> {};

TEST_P(EveryEffect, IsFoundWithItsSize) {
  const model::effects::Effect& effect = *GetParam();
  const auto side = effect.sides.front();
  model::Machine machine;
  if (effect.part == model::effects::Part::brackets) machine.attachment = model::Brackets{};
  std::vector<double> values = model::effects::nominal_values(effect);
  if (!effect.parameters.front().integer) {
    // A signal-to-noise ratio of about 25 on the 7 x 4 grid of the default machine, computed from
    // the strength at the usual size.
    synthetic::StrengthTable table(machine, synthetic::regular_session({}, 7, 4),
                                   StatedNoise{0.2, 0.3, 12.0});
    const double factor = 25.0 / table.strength(effect, side).signal_to_noise;
    const double limit = effect.parameters.front().upper / values.front();
    values.front() *= std::min(factor, 0.9 * limit);
    if (table.strength(effect, side).signal_to_noise * std::min(factor, 0.9 * limit) < 10.0) {
      GTEST_SKIP() << effect.id << " never shows enough on this grid: calibration takes it up";
    }
  }
  const auto applied = model::effects::applied(effect, side, values);
  const auto answer = diagnose(session_of({applied}, 7, 7, 4, machine), verdict_alone());
  ASSERT_TRUE(answer) << answer.error().sentence();
  SCOPED_TRACE(answer->sentence);
  ASSERT_FALSE(answer->causes.empty());
  const Cause& lead = answer->causes.front();
  const auto is_it = [&](const CauseId& c) { return c.effect == &effect && c.side == side; };
  const std::vector<ParameterEstimate>* found = is_it(lead.cause) ? &lead.parameters : nullptr;
  for (const SameCause& same : lead.same_as) {
    if (is_it(same.cause)) found = &same.parameters;
  }
  ASSERT_NE(found, nullptr);
  const ParameterEstimate& size = found->front();
  // Four sigma, and 1 % of the size for secants of effects that grow faster than linearly.
  EXPECT_NEAR(size.value, values.front(), 4.0 * size.sigma + 0.01 * std::abs(values.front()));
}

std::string name_of_effect(const testing::TestParamInfo<const model::effects::Effect*>& info) {
  return std::string(info.param->id);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect,
                         testing::ValuesIn(model::effects::catalogue().begin(),
                                           model::effects::catalogue().end()),
                         name_of_effect);

TEST(Diagnose, ClassesComeFromTheSignatures) {
  const Analysis analysis = testing_support::analysis_of(session_of({}, 5));
  const CauseId pitch{model::effects::find_effect("chain_pitch_error"),
                      model::effects::EffectSide::both};
  const CauseId tape{model::effects::find_effect("tape_scale"), model::effects::EffectSide::both};
  for (const CauseClass& members : analysis.decision.classes) {
    const bool has = std::find(members.begin(), members.end(), pitch) != members.end();
    if (!has) {
      EXPECT_EQ(members.size(), 1u) << members.front().effect->id;
      continue;
    }
    EXPECT_EQ(members, (CauseClass{pitch, tape}));
  }
}

TEST(Diagnose, ALinkReadingSeparatesPitchFromTape) {
  // 0.3 % on the paper; the measured links are nominal.
  MeasuredGrid grid = session_of({{"tape_scale", "both", {{"scale", 0.003}}}}, 9);
  const auto before = diagnose(grid, verdict_alone());
  ASSERT_TRUE(before);
  ASSERT_EQ(before->verdict, Verdict::named) << before->sentence;
  EXPECT_EQ(before->causes.front().cause.effect->id, "chain_pitch_error");
  ASSERT_EQ(before->causes.front().same_as.size(), 1u);
  EXPECT_TRUE(before->extended_machine.effects.empty()) << "not before somebody read the links";
  grid.readings.push_back({ReadingOf::link_pitch, "left", 6.350, 0.001});
  grid.readings.push_back({ReadingOf::link_pitch, "right", 6.350, 0.001});
  const auto after = diagnose(grid, verdict_alone());
  ASSERT_TRUE(after);
  ASSERT_EQ(after->verdict, Verdict::named) << after->sentence;
  EXPECT_EQ(after->causes.front().cause.effect->id, "tape_scale");
  EXPECT_TRUE(after->extended_machine.effects.empty()) << "paper never goes into the machine";
  ASSERT_EQ(after->data_corrections.size(), 1u);
}

TEST(Diagnose, AnotherTapeSeparatesTapeFromPitch) {
  MeasuredGrid grid = session_of({{"tape_scale", "both", {{"scale", 0.003}}}}, 9);
  grid.readings.push_back({ReadingOf::tape_error, "x", 3.1, 0.15});
  grid.readings.push_back({ReadingOf::tape_error, "y", 2.9, 0.15});
  const auto tape = diagnose(grid, verdict_alone());
  ASSERT_TRUE(tape);
  ASSERT_EQ(tape->verdict, Verdict::named) << tape->sentence;
  EXPECT_EQ(tape->causes.front().cause.effect->id, "tape_scale");
  ASSERT_EQ(tape->data_corrections.size(), 1u);
  for (auto& reading : grid.readings) reading.value -= 3.0;
  const auto chain = diagnose(grid, verdict_alone());
  ASSERT_TRUE(chain);
  ASSERT_EQ(chain->verdict, Verdict::named) << chain->sentence;
  EXPECT_EQ(chain->causes.front().cause.effect->id, "chain_pitch_error");
  EXPECT_TRUE(chain->causes.front().same_as.empty()) << "the tape is known to be right";
  ASSERT_EQ(chain->extended_machine.effects.size(), 1u);
}

TEST(Diagnose, WithoutOrderTheVisitsAreNotTestable) {
  MeasuredGrid grid = session_of({}, 11);
  for (MeasuredPoint& p : grid.points) p.order.reset();
  const auto answer = diagnose(grid, verdict_alone());
  ASSERT_TRUE(answer);
  for (const char* id :
       {"drift", "tooth_skip", "link_miscount", "zero_shift", "direction_hysteresis"}) {
    const auto said = std::count_if(answer->not_testable.begin(), answer->not_testable.end(),
                                    [&](const NotTestable& n) { return n.cause.effect->id == id; });
    EXPECT_EQ(said, static_cast<std::ptrdiff_t>(model::effects::find_effect(id)->sides.size()))
        << id;
    EXPECT_TRUE(std::none_of(answer->bounds.begin(), answer->bounds.end(), [&](const Bound& b) {
      return b.cause.effect->id == id;
    })) << "not testable is not absent";
  }
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
