// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All problems of a machine's effects are reported, each with its place, value and what was
/// expected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <ostream>

#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::model {

void PrintTo(const MachineProblem& p, std::ostream* os) {
  *os << p.parameter << ": found " << p.value << ", expected " << p.expected;
}

namespace effects {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

auto problem(const std::string& place, const std::string& value, const std::string& expected) {
  return AllOf(Field(&MachineProblem::parameter, place),
               Field(&MachineProblem::value, value),
               Field(&MachineProblem::expected, HasSubstr(expected)));
}

std::vector<MachineProblem> problems(const std::vector<AppliedEffect>& applied) {
  Machine machine;
  machine.effects = applied;
  return problems_of_effects(machine);
}

TEST(ProblemsOfEffects, AreReportedAllAtOnceWithTheirPlaces) {
  EXPECT_THAT(
      problems({{"chain_rust", "", {}},
                {"drift", "x", {{"rate_mm_per_visit", 0.02}}},
                {"drift", "left", {{"rate", 0.02}}},
                {"tooth_skip", "left", {{"links", 1.5}, {"first_visit", -3.0}}}}),
      ElementsAre(
          problem("/effects/0/effect", "chain_rust", "\"tape_scale\", \"axes_skew\""),
          problem("/effects/1/side", "x", "\"left\", \"right\" or \"both\""),
          problem("/effects/2/parameters/rate_mm_per_visit", "", "a number from -1 to 1"),
          problem("/effects/2/parameters/rate", "0.02", "drift takes \"rate_mm_per_visit\""),
          problem("/effects/3/parameters/links", "1.5", "a whole number from -20 to 20"),
          problem("/effects/3/parameters/first_visit", "-3", "a whole number from 0")));
}

TEST(ProblemsOfEffects, KnowWhichSidesAnEffectHas) {
  EXPECT_THAT(problems({{"ring_radius", "left", {{"offset_mm", 1.0}}}}),
              ElementsAre(problem("/effects/0/side", "left", "no side (null)")));
  EXPECT_THAT(problems({{"drift", "", {{"rate_mm_per_visit", 0.1}}}}),
              ElementsAre(problem("/effects/0/side", "null", "\"left\"")));
  EXPECT_THAT(problems({{"tape_scale", "left", {{"scale", 0.001}}}}),
              ElementsAre(problem("/effects/0/side", "left", "\"x\", \"y\" or \"both\"")));
  EXPECT_THAT(problems({{"angular_kink", "both", {{"slope_mm_per_rad", 1.0}, {"knee_rad", 0.5}}}}),
              ElementsAre(problem("/effects/0/side", "both", "\"left\" or \"right\"")));
}

TEST(ProblemsOfEffects, RefuseNegativeValuesWhereNoneCanBe) {
  EXPECT_THAT(problems({{"chain_stretch", "", {{"compliance_per_n", -1e-6}}}}),
              ElementsAre(problem("/effects/0/parameters/compliance_per_n", "-1e-06", "from 0")));
  EXPECT_THAT(
      problems({{"beam_flex", "", {{"flexibility_mm_per_n", -0.01}}}}),
      ElementsAre(problem("/effects/0/parameters/flexibility_mm_per_n", "-0.01", "from 0")));
  EXPECT_THAT(problems({{"chain_plane_offset", "", {{"distance_mm", -30.0}}}}),
              ElementsAre(problem("/effects/0/parameters/distance_mm", "-30", "from 0")));
  EXPECT_THAT(problems({{"direction_hysteresis", "both", {{"half_width_mm", -0.3}}}}),
              ElementsAre(problem("/effects/0/parameters/half_width_mm", "-0.3", "from 0")));
  EXPECT_THAT(
      problems({{"sprocket_eccentricity", "left", {{"amplitude_mm", -0.3}, {"phase_rad", 0.0}}}}),
      ElementsAre(problem("/effects/0/parameters/amplitude_mm", "-0.3", "from 0")));
}

TEST(ProblemsOfEffects, RefuseWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THAT(
      problems({{"side_pull", "", {{"force_n", nan}}},
                {"chain_sag", "", {{"relative_weight", infinite}}}}),
      ElementsAre(problem("/effects/0/parameters/force_n", "nan", "a number from"),
                  problem("/effects/1/parameters/relative_weight", "inf", "a number from")));
}

TEST(ProblemsOfEffects, RefuseSumsThatLeaveNoMachine) {
  EXPECT_THAT(problems({{"chain_sag", "", {{"relative_weight", -0.9}}}}), IsEmpty());
  Machine small_ring;
  small_ring.attachment = Ring{20.0};
  small_ring.effects = {{"ring_radius", "", {{"offset_mm", -25.0}}}};
  EXPECT_THAT(
      problems_of_effects(small_ring),
      ElementsAre(problem("/effects/0", "ring_radius", "ring radius and compliance not below 0")));
}

TEST(ProblemsOfEffects, NeedAMachineToActOn) {
  Machine brackets;
  brackets.attachment = Brackets{};
  brackets.effects = {{"ring_radius", "", {{"offset_mm", 1.0}}}};
  EXPECT_THAT(problems_of_effects(brackets),
              ElementsAre(problem("/effects/0/effect", "ring_radius", "a sled on a ring")));
}

TEST(ProblemsOfEffects, AreABrokenPreconditionOfTheReadingModel) {
  Machine machine;
  machine.effects = {{"chain_rust", "", {}}};
  EXPECT_THROW(ReadingModel{machine}, std::invalid_argument);
  EXPECT_THROW(MarkFrame{machine}, std::invalid_argument);
}

}  // namespace
}  // namespace effects
}  // namespace chaintrue::model
