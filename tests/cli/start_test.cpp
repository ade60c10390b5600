// SPDX-License-Identifier: GPL-3.0-or-later
// chaintrue start: from a controller's settings of any kind to a folder for the workshop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "grid/files/machine_file.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

constexpr const char* kWebcontrol = R"({
  "Maslow Settings": [
    {"key": "motorSpacingX", "value": "2978.4", "title": "Distance Between Motors"},
    {"key": "motorOffsetY", "value": "463"},
    {"key": "bedWidth", "value": "2438.4"},
    {"key": "bedHeight", "value": 1219.2}
  ],
  "Advanced Settings": [
    {"key": "gearTeeth", "value": "10"},
    {"key": "chainPitch", "value": "6.35"},
    {"key": "leftChainTolerance", "value": "0.12"},
    {"key": "chainOverSprocket", "value": "Top"},
    {"key": "kinematicsType", "value": "Triangular"},
    {"key": "rotationRadius", "value": "139.6"},
    {"key": "chainSagCorrection", "value": "7.815891"}
  ]
})";

constexpr const char* kFluidnc = R"(name: "plotter"
kinematics:
  WallPlotter:
    left_anchor_x: -1200.000   # from the middle
    left_anchor_y: 900
    right_anchor_x: 1200.000
    right_anchor_y: 900
axes:
  x:
    max_travel_mm: 2000.000
  y:
    max_travel_mm: 1200.000
)";

class Start : public testing_support::CommandFixture {
 protected:
  const std::string ini_ = std::string(CHAINTRUE_FIXTURES) + "/good/groundcontrol_ring.ini";
};

TEST_F(Start, MakesAFolderWhoseNextStepWorks) {
  const Outcome start = run("start " + ini_ + " shop");
  ASSERT_EQ(start.code, 0) << start.err;
  for (const char* file : {"machine.json",
                           "README.txt",
                           "marks.csv",
                           "marks.html",
                           "marks.nc",
                           "holes.csv",
                           "holes.html",
                           "holes.nc"}) {
    EXPECT_TRUE(exists(std::string("shop/") + file)) << file;
  }
  EXPECT_THAT(start.err,
              HasSubstr("Next: chaintrue fit shop/marks.csv --machine shop/machine.json --causes -o "
                        "shop/map.json\n"));
  // Nothing was measured yet; this is the message of the next step.
  const Outcome next = run("fit shop/marks.csv --machine shop/machine.json -o shop/map.json");
  EXPECT_EQ(next.code, 3);
  EXPECT_THAT(next.err, HasSubstr("all left blank"));
  EXPECT_THAT(content_of(folder_ / "shop" / "README.txt"),
              HasSubstr("chaintrue export groundcontrol map.json"));
}

TEST_F(Start, TakesWebControlsSettings) {
  write("webcontrol.json", kWebcontrol);
  const Outcome start = run("start webcontrol.json shop");
  ASSERT_EQ(start.code, 0) << start.err;
  const auto machine = grid::files::read_machine(folder_ / "shop" / "machine.json");
  EXPECT_EQ(std::get<model::Ring>(machine.attachment).radius_mm, 139.6);
  EXPECT_EQ(machine.controller.settings.chain_sag_correction, 7.815891);
  EXPECT_EQ(machine.controller.settings.bed_height_mm, 1219.2);
  ASSERT_EQ(machine.effects.size(), 1U);
  EXPECT_EQ(machine.effects.front().side, "left");
}

TEST_F(Start, NamesThePlaceOfAWrongSetting) {
  std::string text = kWebcontrol;
  text.replace(text.find("2978.4"), 6, "wide");
  write("webcontrol.json", text);
  const Outcome start = run("start webcontrol.json shop");
  EXPECT_EQ(start.code, 3);
  EXPECT_THAT(start.err,
              HasSubstr("/Maslow Settings/0/value: found wide, expected a number in mm"));
  EXPECT_FALSE(exists("shop"));
}

TEST_F(Start, TakesFluidncsAnchors) {
  write("config.yaml", kFluidnc);
  const Outcome start = run("start config.yaml shop");
  ASSERT_EQ(start.code, 0) << start.err;
  EXPECT_THAT(start.err, HasSubstr("FluidNC does not say what hangs on the anchors"));
  const auto machine = grid::files::read_machine(folder_ / "shop" / "machine.json");
  EXPECT_EQ(machine.motors.left.x_mm, -1200.0);
  EXPECT_EQ(machine.motors.right.y_mm, 900.0);
  EXPECT_EQ(machine.bed.height_mm, 1200.0);
  EXPECT_EQ(machine.controller.kind, model::ControllerKind::fluidnc_wallplotter);
}

TEST_F(Start, WithoutAFileWritesAMachineFileThatExplainsItself) {
  const Outcome start = run("start");
  ASSERT_EQ(start.code, 0) << start.err;
  EXPECT_THAT(start.err, HasSubstr("Next: chaintrue start my-machine/machine.json\n"));
  const std::string machine = content_of(folder_ / "my-machine" / "machine.json");
  for (const char* key : {"bed: ", "motors: ", "sled: ", "controller: ", "uncertainty: "})
    EXPECT_THAT(machine, HasSubstr(key));
  const Outcome next = run("start my-machine/machine.json");
  ASSERT_EQ(next.code, 0) << next.err;
  EXPECT_TRUE(exists("my-machine/marks.html"));
  EXPECT_EQ(content_of(folder_ / "my-machine" / "machine.json"), machine);
}

TEST_F(Start, ReplacesNothingThatSomebodyFilledIn) {
  ASSERT_EQ(run("start " + ini_ + " shop").code, 0);
  EXPECT_EQ(run("start " + ini_ + " shop").code, 0);
  write("shop/marks.csv", "order,commanded_x_mm,commanded_y_mm,x_mm,y_mm\n1,0,0,0.5,0.5\n");
  const Outcome again = run("start " + ini_ + " shop");
  EXPECT_EQ(again.code, 3);
  EXPECT_THAT(again.err, AllOf(HasSubstr("shop/marks.csv"), HasSubstr("--force")));
}

TEST_F(Start, TakesAnIniThatBeginsWithItsFirstSection) {
  write("groundcontrol.ini",
        "[Maslow Settings]\nbedwidth = 2438.4\nbedheight = 1219.2\nmotorspacingx = 2978.4\n"
        "motoroffsety = 463\n[Advanced Settings]\nkinematicstype = Triangular\n"
        "rotationradius = 139.1\nchainpitch = 6.35\ngearteeth = 10\nchainoversprocket = Top\n");
  const Outcome outcome = run("start groundcontrol.ini shop");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

/// Every verb that plans finds room down to the smallest bed that a machine may have.
TEST_F(Start, SmallBedsArePlannedDownToTheSmallest) {
  for (const int side : {500, 450, 300, 200}) {
    SCOPED_TRACE(side);
    write("small.json",
          R"({"file_type": "chaintrue_machine", "format_version": "1.0", "name": "small",
 "bed": {"width_mm": )" +
              std::to_string(side) + R"(, "height_mm": )" + std::to_string(side) + R"(},
 "motors": {"left": {"x_mm": -400, "y_mm": 420}, "right": {"x_mm": 400, "y_mm": 420}},
 "sprocket": {"teeth": 10, "pitch_mm": 6.35}, "feed": "over_top",
 "attachment": {"kind": "ring", "radius_mm": 40}, "chain": {"mass_kg_per_m": 0.14, "compliance_per_n": 5.17e-6},
 "sled": {"mass_kg": 3}, "frame": {"tilt_from_vertical_deg": 15}})");
    for (const char* line :
         {"start small.json shop --force",
          "plan --machine small.json --points 28 -o marks.csv --force",
          "plan --machine small.json --holes 9 -o holes.csv --force",
          "simulate --machine small.json --holes 9 --seed 1 -o holes.json --force",
          "passes --machine small.json --passes 1 --seed 1"}) {
      const Outcome outcome = run(line);
      EXPECT_EQ(outcome.code, 0) << line << "\n" << outcome.err;
    }
  }
}

TEST_F(Start, ABedThatIsTooSmallIsSaid) {
  write("plotter.yaml",
        "kinematics:\n  WallPlotter:\n    left_anchor_x: -300\n    left_anchor_y: 300\n"
        "    right_anchor_x: 300\n    right_anchor_y: 300\n"
        "axes:\n  x:\n    max_travel_mm: 150\n  y:\n    max_travel_mm: 150\n");
  const Outcome outcome = run("start plotter.yaml shop");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("max_travel_mm"));
  EXPECT_THAT(outcome.err, HasSubstr("200"));
  EXPECT_FALSE(exists("shop/marks.csv"));
}

}  // namespace
}  // namespace chaintrue
