// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers to type in, from maps of machines for which exact settings exist.
#include "grid/map/settings_to_type.hpp"

#include <gmock/gmock.h>

#include "grid/map/fit.hpp"
#include "model/controllers/payout.hpp"
#include "model/reading_model.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue::grid {
namespace {

using model::ControllerSettings;
using model::Machine;

/// A machine from GroundControl's settings; owners' calibrations give a sag factor like this one.
Machine imported_machine() {
  Machine machine;
  machine.controller.kind = model::ControllerKind::maslow_classic;
  ControllerSettings& settings = machine.controller.settings;
  settings.bed_width_mm = machine.bed.width_mm;
  settings.bed_height_mm = machine.bed.height_mm;
  settings.motor_spacing_mm = 2978.4;
  settings.motor_offset_y_mm = 463.0;
  settings.rotation_radius_mm = 139.1;
  settings.chain_sag_correction = 25.0;
  settings.left_chain_tolerance_percent = 0.12;
  settings.right_chain_tolerance_percent = 0.17;
  machine.effects = {{"chain_pitch_error", "left", {{"elongation", 0.0012}}},
                     {"chain_pitch_error", "right", {{"elongation", 0.0017}}}};
  return machine;
}

/// 28 commands and the tool's positions, for a machine that is exact with the settings `right`.
MeasuredGrid grid_of(const Machine& machine, const ControllerSettings& right) {
  Machine would_be_right = machine;
  would_be_right.controller.settings = right;
  const auto answer = model::make_controller_kinematics(machine);
  const auto true_one = model::make_controller_kinematics(would_be_right);
  MeasuredGrid grid;
  grid.machine = machine;
  grid.noise = StatedNoise{0.1, 0.1, 15.0};
  for (const model::BedPoint& command : testing_support::commands(7, 4)) {
    grid.points.push_back({model::identity_placement(*true_one->command(*answer->lengths(command))),
                           std::nullopt, command, std::nullopt});
  }
  return grid;
}

TEST(SettingsToType, StayTheSameForASoundMachine) {
  const Machine machine = imported_machine();
  const auto map = fit(grid_of(machine, machine.controller.settings));
  ASSERT_TRUE(map) << map.error().sentence();
  for (const MapPoint& point : map->contents().points) {
    // Newton of the controller's formulas: 1e-9 mm, and a few roundings of metres.
    EXPECT_NEAR(point.as_stated_mm.norm(), 0.0, 1e-8);
  }
  const auto typed = settings_to_type(*map);
  ASSERT_TRUE(typed) << typed.error().sentence();
  EXPECT_FALSE(typed->worth_typing);
  EXPECT_EQ(typed->settings.motor_spacing_mm, 2978.4);
  EXPECT_EQ(typed->settings.chain_sag_correction, 25.0);
  // The map's error for the firmware's formulas away from its points: less than twice its own
  // expected error.
  EXPECT_LT(typed->as_it_is.rms_mm, 2.0 * map->contents().accuracy.expected_tool.rms_mm);
}

/// A machine whose controller runs with its own settings where `right` would be exact.
void expect_brought_back(const Machine& machine, const ControllerSettings& right) {
  const auto map = fit(grid_of(machine, right));
  ASSERT_TRUE(map) << map.error().sentence();
  const auto typed = settings_to_type(*map);
  ASSERT_TRUE(typed) << typed.error().sentence();
  EXPECT_TRUE(typed->worth_typing);
  EXPECT_EQ(typed->points, 28U);
  EXPECT_GT(typed->as_it_is.rms_mm, 2.0) << "the machine was not wrong to begin with";
  // Exact settings exist; the map determines them to a tenth of a millimetre.
  EXPECT_LT(typed->typed.rms_mm, 0.15);
  // The effect of the settings at positions that were not fitted: the tool itself.
  Machine mended = machine;
  mended.controller.settings = typed->settings;
  Machine truth = machine;
  truth.controller.settings = right;
  const auto answer = model::make_controller_kinematics(mended);
  const auto goes = model::make_controller_kinematics(truth);
  for (const model::BedPoint command :
       {model::BedPoint{-900.0, -340.0}, model::BedPoint{0.0, 170.0},
        model::BedPoint{900.0, 400.0}}) {
    const model::BedPoint went = *goes->command(*answer->lengths(command));
    // Three sigmas of the map's expected error on each axis.
    EXPECT_NEAR(went.x_mm, command.x_mm, 0.3);
    EXPECT_NEAR(went.y_mm, command.y_mm, 0.3);
  }
}

TEST(SettingsToType, RemoveTheErrorOfTheTool) {
  const Machine machine = imported_machine();
  ControllerSettings right = machine.controller.settings;
  *right.motor_spacing_mm += 5.0;
  *right.rotation_radius_mm -= 1.5;
  *right.chain_sag_correction = 8.0;
  *right.right_chain_tolerance_percent = 0.08;
  expect_brought_back(machine, right);
}

TEST(SettingsToType, RemoveTheErrorOfASledOnBrackets) {
  Machine machine = imported_machine();
  machine.attachment = model::Brackets{};
  machine.effects.clear();
  ControllerSettings& settings = machine.controller.settings;
  settings.rotation_radius_mm.reset();
  settings.chain_sag_correction.reset();
  settings.left_chain_tolerance_percent.reset();
  settings.right_chain_tolerance_percent.reset();
  settings.sled_width_mm = 310.0;
  settings.sled_height_mm = 139.0;
  settings.sled_cg_mm = 79.0;
  ControllerSettings right = settings;
  *right.motor_spacing_mm += 4.0;
  *right.sled_width_mm += 2.0;
  *right.sled_height_mm -= 3.0;
  *right.sled_cg_mm += 6.0;
  expect_brought_back(machine, right);
}

TEST(SettingsToType, AreNotMadeForOtherControllers) {
  Machine machine = imported_machine();
  MeasuredGrid grid = grid_of(machine, machine.controller.settings);
  grid.machine->controller = {model::ControllerKind::fluidnc_wallplotter, {}};
  const auto map = fit(grid);
  ASSERT_TRUE(map) << map.error().sentence();
  const auto typed = settings_to_type(*map);
  ASSERT_FALSE(typed);
  EXPECT_EQ(typed.error().reason, SettingsFailure::Reason::another_controller);
  EXPECT_THAT(typed.error().sentence(), testing::HasSubstr("compensate the G-code"));
}

std::vector<model::BedPoint> corners() {
  return {{-1100.0, -500.0}, {1100.0, -500.0}, {1100.0, 500.0}, {-1100.0, 500.0}};
}

std::vector<std::string> names_of(const std::vector<Lacking>& lacking) {
  std::vector<std::string> names;
  for (const Lacking& one : lacking) names.push_back(one.what);
  return names;
}

// The same result from a machine and from a map of it.
TEST(SettingsToType, EqualTheMachineOfTheMap) {
  Machine machine = imported_machine();
  machine.motors.left.x_mm -= 3.0;
  machine.motors.right.x_mm += 4.0;
  machine.effects.push_back({"chain_pitch_error", "right", {{"elongation", 0.0010}}});
  MeasuredGrid grid;
  grid.machine = imported_machine();
  grid.noise = StatedNoise{0.01, 0.01, 15.0};
  const auto chains = model::make_chain_mechanism(machine);
  for (const model::BedPoint& at : testing_support::commands(9, 5)) {
    grid.points.push_back({model::identity_placement(at),
                           *chains->first_lengths({at.x_mm, at.y_mm}), std::nullopt, std::nullopt});
  }
  const auto map = fit(grid);
  ASSERT_TRUE(map) << map.error().sentence();
  const auto by_map = settings_to_type(*map);
  const auto by_machine = settings_to_type(machine, corners());
  ASSERT_TRUE(by_map && by_machine);
  EXPECT_TRUE(by_machine->worth_typing);
  // The map's machine has another prior and errs by hundredths of a millimetre.
  EXPECT_NEAR(by_machine->as_it_is.rms_mm, by_map->as_it_is.rms_mm, 0.05);
  EXPECT_NEAR(by_machine->typed.rms_mm, by_map->typed.rms_mm, 0.05);
  EXPECT_LE(by_machine->typed.rms_mm, by_machine->as_it_is.rms_mm);
}

// A beam that bends and a beam that is not level have no number in the stock firmware: its tilt is
// unchanged, and their contribution is reported.
TEST(SettingsToType, ReportWhatTheFirmwareLacks) {
  Machine machine = imported_machine();
  machine.controller.settings.top_beam_tilt_deg = 0.0;
  machine.motors.right.y_mm += 8.0;
  machine.effects.push_back({"beam_flex", "", {{"flexibility_mm_per_n", 0.02}}});
  const auto stock = settings_to_type(machine, corners());
  ASSERT_TRUE(stock) << stock.error().sentence();
  EXPECT_EQ(stock->settings.top_beam_tilt_deg, 0.0);
  EXPECT_THAT(names_of(stock->lacking), testing::IsSupersetOf({"top_beam_tilt", "beam_flex"}));
  EXPECT_LE(stock->typed.rms_mm, stock->as_it_is.rms_mm);
  machine.controller.kind = model::ControllerKind::holey;
  const auto holey = settings_to_type(machine, corners());
  ASSERT_TRUE(holey) << holey.error().sentence();
  EXPECT_GT(*holey->settings.top_beam_tilt_deg, 0.0);
  EXPECT_LT(holey->typed.rms_mm, stock->typed.rms_mm);
  EXPECT_THAT(names_of(holey->lacking), testing::Not(testing::Contains("top_beam_tilt")));
}

}  // namespace
}  // namespace chaintrue::grid
