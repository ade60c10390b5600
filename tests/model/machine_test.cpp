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
using testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Machine, SprocketsRadiusIsThePitchLinesUnlessStated) {
  Sprocket sprocket;
  EXPECT_DOUBLE_EQ(sprocket.effective_radius_mm(), 63.5 / (2.0 * std::numbers::pi));
  sprocket.radius_mm = 10.2745;
  EXPECT_EQ(sprocket.effective_radius_mm(), 10.2745);
}

TEST(Machine, RealMachinesAreSound) {
  Machine machine;
  EXPECT_THAT(problems_of(machine), IsEmpty());
  machine.attachment = Brackets{};
  EXPECT_THAT(problems_of(machine), IsEmpty());
  // A pen plotter with belts, and a twelve-foot beam under a heavy router.
  Machine small;
  small.bed = {400.0, 300.0};
  small.motors = {{-300.0, 250.0}, {300.0, 250.0}};
  small.attachment = Ring{0.0};
  small.sled.mass_kg = 0.15;
  small.chain = {0.006, 2e-5};
  small.sprocket = {20, 2.0, std::nullopt};
  EXPECT_THAT(problems_of(small), IsEmpty());
  Machine large;
  large.motors = {{-1830.0, 1100.0}, {1830.0, 1130.0}};
  large.sled.mass_kg = 25.0;
  EXPECT_THAT(problems_of(large), IsEmpty());
}

struct Slip {
  const char* name;
  std::function<void(Machine&)> make;
  const char* parameter;
  const char* says;
};

// Each mistake is rejected with its place, its value and what was expected.
TEST(Machine, SlipsAreNamedWithPlaceValueAndRange) {
  const Slip slips[] = {
      {"bed in inches",
       [](Machine& m) {
         m.bed = {96.0, 48.0};
       },
       "/bed/width_mm",
       "inches"},
      {"motors in inches",
       [](Machine& m) {
         m.motors = {{-58.6, 42.2}, {58.6, 42.2}};
         m.bed = {2438.4, 1219.2};
       },
       "/motors/right/x_mm",
       "300 mm"},
      {"motors below the bed",
       [](Machine& m) { m.motors.left.y_mm = m.motors.right.y_mm = -1072.6; },
       "/motors/left/y_mm",
       "above the bed"},
      {"motors swapped",
       [](Machine& m) { std::swap(m.motors.left, m.motors.right); },
       "/motors/left/x_mm",
       "swapped"},
      {"one motor far lower",
       [](Machine& m) { m.motors.right.y_mm = 7000.0; },
       "/motors/right/y_mm",
       "beam"},
      {"sled in grams", [](Machine& m) { m.sled.mass_kg = 11600.0; }, "/sled/mass_kg", "grams"},
      {"no sled", [](Machine& m) { m.sled.mass_kg = 0.0; }, "/sled/mass_kg", "0.05 to 200"},
      {"chain in grams",
       [](Machine& m) { m.chain.mass_kg_per_m = 140.0; },
       "/chain/mass_kg_per_m",
       "grams"},
      {"negative chain",
       [](Machine& m) { m.chain.mass_kg_per_m = -0.1; },
       "/chain/mass_kg_per_m",
       "0 to 5"},
      {"rubber chain",
       [](Machine& m) { m.chain.compliance_per_n = 5.17; },
       "/chain/compliance_per_n",
       "strain"},
      {"tilt from the floor",
       [](Machine& m) { m.frame.tilt_from_vertical_deg = 80.0; },
       "/frame/tilt_from_vertical_deg",
       "vertical"},
      {"ring in inches",
       [](Machine& m) { m.attachment = Ring{5.5}; },
       "/attachment/radius_mm",
       "inches"},
      {"pitch in inches",
       [](Machine& m) { m.sprocket.pitch_mm = 0.25; },
       "/sprocket/pitch_mm",
       "inches"},
      {"no teeth", [](Machine& m) { m.sprocket.teeth = 0; }, "/sprocket/teeth", "3 to 100"},
      {"radius not a number",
       [](Machine& m) { m.sprocket.radius_mm = kNan; },
       "/sprocket/radius_mm",
       "number"},
      {"motor nowhere",
       [](Machine& m) { m.motors.left.x_mm = kNan; },
       "/motors/left/x_mm",
       "number"},
      {"infinite bed",
       [](Machine& m) { m.bed.height_mm = std::numeric_limits<double>::infinity(); },
       "/bed/height_mm",
       "number"},
      {"negative uncertainty",
       [](Machine& m) { m.uncertainty.motor_position_mm = -1.0; },
       "/uncertainty/motor_position_mm",
       "0 to 1000"},
      {"setting not a number",
       [](Machine& m) { m.controller.settings.chain_sag_correction = kNan; },
       "/controller/settings/chainsagcorrection",
       "number"},
      {"brackets too narrow",
       [](Machine& m) {
         m.attachment = Brackets{12.2, 139.0, 79.0};
       },
       "/attachment/spacing_mm",
       "inches"},
  };
  for (const Slip& slip : slips) {
    SCOPED_TRACE(slip.name);
    Machine machine;
    slip.make(machine);
    EXPECT_THAT(
        problems_of(machine),
        Contains(testing::AllOf(testing::Field(&MachineProblem::parameter, slip.parameter),
                                testing::Field(&MachineProblem::value, testing::Not(IsEmpty())),
                                testing::Field(&MachineProblem::expected, HasSubstr(slip.says)))));
  }
}

TEST(Machine, AllProblemsAreReportedAtOnce) {
  Machine machine;
  machine.sled.mass_kg = -1.0;
  machine.chain.mass_kg_per_m = kNan;
  machine.bed.width_mm = 0.0;
  EXPECT_THAT(problems_of(machine), testing::SizeIs(3));
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
  EXPECT_THAT(message([](auto& m) { m.sled_weight_n = 0.0; }),
              HasSubstr("sled_weight_n = 0: expected"));
  EXPECT_THAT(message([](auto& m) { m.sled_weight_n = kNan; }), HasSubstr("sled_weight_n = nan"));
  EXPECT_THAT(message([](auto& m) { m.chain_weight_n_per_mm = -1e-3; }),
              HasSubstr("chain_weight_n_per_mm = -0.001"));
  EXPECT_THAT(message([](auto& m) { m.chain_compliance_per_n = 1.0; }),
              HasSubstr("chain_compliance_per_n = 1"));
  EXPECT_THAT(message([](auto& m) { m.sprocket_radius_mm = -10.0; }),
              HasSubstr("sprocket_radius_mm = -10"));
  EXPECT_THAT(message([](auto& m) { m.attachment = Ring{-1.0}; }),
              HasSubstr("ring_radius_mm = -1"));
  EXPECT_THAT(message([](auto& m) {
                m.attachment = Brackets{kNan, 1.0, 1.0};
              }),
              HasSubstr("spacing_mm = nan"));
  EXPECT_THAT(message([](auto& m) { m.tilt_rad = 1.6; }), HasSubstr("tilt_rad = 1.6"));
  EXPECT_THAT(message([](auto& m) { m.beam_flexibility_mm_per_n = -0.1; }),
              HasSubstr("beam_flexibility"));
  EXPECT_THAT(message([](auto& m) { m.side_force_n = kNan; }), HasSubstr("side_force_n"));
  EXPECT_THAT(message([](auto& m) { std::swap(m.motors.left, m.motors.right); }),
              HasSubstr("right of the left one"));
  EXPECT_THAT(message([](auto& m) { m.motors.left.y_mm = kNan; }), HasSubstr("motor y_mm = nan"));
}

TEST(Machine, FailuresHaveNamesAndSentences) {
  for (const PoseReason reason : {PoseReason::outside_verticals,
                                  PoseReason::above_sprockets,
                                  PoseReason::link_does_not_fit,
                                  PoseReason::slack,
                                  PoseReason::too_short,
                                  PoseReason::not_converged}) {
    EXPECT_THAT(std::string(name(reason)), testing::MatchesRegex("[a-z_]+"));
    EXPECT_GT(PoseFailure(reason).sentence().size(), 20u);
  }
}

}  // namespace
}  // namespace chaintrue::model
