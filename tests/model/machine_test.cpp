// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/machine.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "model/kinematics.hpp"

namespace chaintrue::model {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Machine, SprocketsRadiusIsThePitchLinesUnlessStated) {
  Sprocket sprocket;
  EXPECT_DOUBLE_EQ(sprocket.effective_radius_mm(), 63.5 / (2.0 * std::numbers::pi));
  sprocket.radius_mm = 10.2745;
  EXPECT_EQ(sprocket.effective_radius_mm(), 10.2745);
}

// What no file can hold. Slips in files are in tests/cli/cases/machine_files.cases.
TEST(Machine, NamesNonFiniteNumbersWithTheirPlace) {
  const auto places = [](const std::function<void(Machine&)>& spoil) {
    Machine machine;
    spoil(machine);
    std::vector<std::string> all;
    for (const MachineProblem& problem : problems_of(machine)) all.push_back(problem.parameter);
    return all;
  };
  EXPECT_THAT(places([](Machine& m) { m.sprocket.radius_mm = kNan; }),
              Contains("/sprocket/radius_mm"));
  EXPECT_THAT(places([](Machine& m) { m.motors.left.x_mm = kNan; }), Contains("/motors/left/x_mm"));
  EXPECT_THAT(places([](Machine& m) { m.bed.height_mm = HUGE_VAL; }), Contains("/bed/height_mm"));
  EXPECT_THAT(places([](Machine& m) { m.controller.settings.chain_sag_correction = kNan; }),
              Contains("/controller/settings/chainsagcorrection"));
}

// Parameters that bypass the file's checks are rejected by the equilibrium, by name and value.
TEST(Machine, KinematicsRefuseParametersByNameAndValue) {
  const auto message = [](const std::function<void(EquilibriumParameters&)>& spoil) -> std::string {
    EquilibriumParameters m = equilibrium_parameters(Machine{});
    spoil(m);
    try {
      std::ignore = make_kinematics(m);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::pair<std::function<void(EquilibriumParameters&)>, const char*> slips[] = {
      {[](auto& m) { m.sled_weight_n = 0.0; }, "sled_weight_n = 0: expected"},
      {[](auto& m) { m.sled_weight_n = kNan; }, "sled_weight_n = nan"},
      {[](auto& m) { m.chain_weight_n_per_mm = -1e-3; }, "chain_weight_n_per_mm = -0.001"},
      {[](auto& m) { m.chain_compliance_per_n = 1.0; }, "chain_compliance_per_n = 1"},
      {[](auto& m) { m.sprocket_radius_mm = -10.0; }, "sprocket_radius_mm = -10"},
      {[](auto& m) { m.attachment = Ring{-1.0}; }, "ring_radius_mm = -1"},
      {[](auto& m) {
         m.attachment = Brackets{kNan, 1.0, 1.0};
       },
       "spacing_mm = nan"},
      {[](auto& m) { m.tilt_rad = 1.6; }, "tilt_rad = 1.6"},
      {[](auto& m) { m.beam_flexibility_mm_per_n = -0.1; }, "beam_flexibility"},
      {[](auto& m) { m.side_force_n = kNan; }, "side_force_n"},
      {[](auto& m) { std::swap(m.motors.left, m.motors.right); }, "right of the left one"},
      {[](auto& m) { m.motors.left.y_mm = kNan; }, "motor y_mm = nan"}};
  for (const auto& [spoil, words] : slips) EXPECT_THAT(message(spoil), HasSubstr(words));
}

TEST(Machine, FailuresHaveNamesAndSentences) {
  for (const PoseReason reason :
       {PoseReason::outside_verticals, PoseReason::above_sprockets, PoseReason::link_does_not_fit,
        PoseReason::slack, PoseReason::too_short, PoseReason::not_converged}) {
    EXPECT_THAT(std::string(name(reason)), testing::MatchesRegex("[a-z_]+"));
    EXPECT_GT(PoseFailure(reason).sentence().size(), 20u);
  }
}

}  // namespace
}  // namespace chaintrue::model
