// SPDX-License-Identifier: GPL-3.0-or-later
// Settings by name, and what counts as a change of one.
#include "grid/files/controller_settings.hpp"

#include <gmock/gmock.h>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

model::Machine imported() {
  return read(parse_groundcontrol, CHAINTRUE_FIXTURES "/good/groundcontrol_ring.ini").machine;
}

TEST(ControllerSettings, UseTheNamesOfTheirFile) {
  const auto settings = settings_in_force(imported());
  ASSERT_FALSE(settings.empty());
  EXPECT_EQ(settings.front().name, "bedwidth");
  EXPECT_EQ(settings.front().text, "2438.4");
}

TEST(ControllerSettings, RoundTripThroughAnExport) {
  model::Machine machine = imported();
  *machine.controller.settings.motor_spacing_mm += 1.23456789;
  const GroundcontrolText text =
      write_groundcontrol_settings(imported(), machine.controller.settings, "a test");
  const model::Machine typed = parse_groundcontrol(text.text, "settings.ini").machine;
  EXPECT_THAT(changed_settings(settings_in_force(machine), settings_in_force(typed)), IsEmpty());
}

TEST(ControllerSettings, NameChangesWithBothValues) {
  model::Machine now = imported();
  const std::string before = settings_in_force(now)[2].text;
  now.controller.settings.motor_spacing_mm = 2982.7791;
  const auto changes = changed_settings(settings_in_force(imported()), settings_in_force(now));
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(in_words(changes), "motorspacingx " + before + " -> 2982.7791");
  EXPECT_THAT(of_the_chain(changes), IsEmpty());
}

TEST(ControllerSettings, UnsetTiltIsZero) {
  model::Machine machine = imported();
  machine.controller.settings.top_beam_tilt_deg.reset();
  model::Machine level = machine;
  level.controller.settings.top_beam_tilt_deg = 0.0;
  EXPECT_THAT(changed_settings(settings_in_force(machine), settings_in_force(level)), IsEmpty());
  level.controller.settings.top_beam_tilt_deg = 0.01;
  EXPECT_THAT(changed_settings(settings_in_force(machine), settings_in_force(level)), SizeIs(1));
}

TEST(ControllerSettings, DistinguishChainSettings) {
  model::Machine now = imported();
  now.controller.settings.chain_pitch_mm = 6.4;
  now.controller.settings.chain_over_sprocket_top =
      !now.controller.settings.chain_over_sprocket_top.value();
  now.controller.settings.rotation_radius_mm = 120.0;
  const auto changes = changed_settings(settings_in_force(imported()), settings_in_force(now));
  EXPECT_THAT(changes, SizeIs(3));
  EXPECT_THAT(of_the_chain(changes), SizeIs(2));
}

TEST(ControllerSettings, ReadAWallPlottersAnchors) {
  model::Machine machine;
  machine.controller.kind = model::ControllerKind::fluidnc_wallplotter;
  std::vector<std::string> names;
  for (const NamedSetting& setting : settings_in_force(machine)) names.push_back(setting.name);
  EXPECT_THAT(names,
              ElementsAre("left_anchor_x", "left_anchor_y", "right_anchor_x", "right_anchor_y"));
}

TEST(FluidNc, EachAnchorHasItsOwnCoordinates) {
  const ReadMachine read = parse_fluidnc(
      "axes:\n"
      "  x:\n    max_travel_mm: 2400\n"
      "  y:\n    max_travel_mm: 1200\n"
      "kinematics:\n"
      "  WallPlotter:\n"
      "    left_anchor_x: -1500\n    left_anchor_y: 1010\n"
      "    right_anchor_x: 1490\n    right_anchor_y: 1020\n",
      "config.yaml");
  const auto& motors = read.machine.motors;
  EXPECT_EQ(motors.left.x_mm, -1500.0);
  EXPECT_EQ(motors.left.y_mm, 1010.0);
  EXPECT_EQ(motors.right.x_mm, 1490.0);
  EXPECT_EQ(motors.right.y_mm, 1020.0);
}

}  // namespace
}  // namespace chaintrue::grid::files
