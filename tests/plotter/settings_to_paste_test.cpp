// SPDX-License-Identifier: GPL-3.0-or-later
/// The lines to paste for a known machine: given scales, zeros and pins come out in each
/// controller's format.
#include "grid/plotter/settings_to_paste.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace chaintrue::grid::plotter_paste_test {
namespace {

using model::PlotterFirmware;
using testing::ElementsAre;

TestDrawing drawing_of(PlotterFirmware firmware, const model::PlotterMachine& stated = {}) {
  TestDrawing drawing = planned_drawing({stated, firmware});
  drawing.pins_middle = {0.0, 500.0};
  return drawing;
}

TEST(SettingsToPaste, HomedOffsetIsAMuralsZero) {
  const model::PlotterMachine stated = model::mural(1500.0);
  model::PlotterMachine truth = stated;
  truth.pin_spacing_mm = 1503.2;
  truth.zero_mm = {23.0, 23.0};
  truth.scale_mm_per_m = {2.0, 2.0};
  EXPECT_THAT(settings_to_paste(drawing_of(PlotterFirmware::mural, stated), truth),
              // (40 - 23) / 1.002 and 12.69 / 1.002.
              ElementsAre("top distance: 1503 mm", "effective pulley diameter: 12.6647 mm",
                          "homed step offset: 16.97 mm"));
}

TEST(SettingsToPaste, FluidncHasBothPinsAndBothScales) {
  model::PlotterMachine truth;
  truth.pin_spacing_mm = 1204.0;
  truth.pin_rise_mm = 6.0;
  truth.scale_mm_per_m = {1.0, -2.0};
  TestDrawing drawing = drawing_of(PlotterFirmware::fluidnc);
  drawing.steps_per_mm = {80.0, 80.0};
  EXPECT_THAT(settings_to_paste(drawing, truth),
              ElementsAre("kinematics:", "  WallPlotter:", "    left_anchor_x: -602.00",
                          "    left_anchor_y: 497.00", "    right_anchor_x: 602.00",
                          "    right_anchor_y: 503.00", "axes:", "  x:",
                          "    steps_per_mm: 80.0800", "  y:", "    steps_per_mm: 79.8400"));
}

TEST(SettingsToPaste, SetThePenPositionInMarlin) {
  model::PlotterMachine truth;
  truth.zero_mm = {5.0, 5.0};
  TestDrawing drawing = drawing_of(PlotterFirmware::marlin);
  drawing.home = model::BedPoint{0.0, -800.0};
  const auto lines = settings_to_paste(drawing, truth);
  // Cords of 1000 mm that are 5 mm shorter: sqrt(995^2 - 600^2) = 793.74 below the pins.
  EXPECT_THAT(lines,
              ElementsAre("M92 X<the present value times 1.000000> Y<the present value times "
                          "1.000000>",
                          "M665 L-600.00 R600.00 T500.00", "M500", "G92 X0.00 Y-293.74"));
}

TEST(SettingsToPaste, PolargraphHasOneScale) {
  model::PlotterMachine truth;
  truth.scale_mm_per_m = {3.0, 1.0};
  EXPECT_THAT(settings_to_paste(drawing_of(PlotterFirmware::polargraph), truth),
              ElementsAre("machine.width=1200.0",
                          "machine.motors.mmPerRev=<the present value times 0.998004>"));
}

TEST(SettingsToPaste, MakeTheControllerCountCordsCorrectly) {
  model::PlotterMachine truth;
  truth.pin_spacing_mm = 1204.0;
  truth.zero_mm = {5.0, 5.0};
  truth.scale_mm_per_m = {1.0, -2.0};
  TestDrawing drawing = drawing_of(PlotterFirmware::fluidnc);
  drawing.steps_per_mm = {80.0, 80.0};
  drawing.home = model::BedPoint{0.0, -800.0};
  const SetPlotter next = once_typed_in(drawing, truth);
  EXPECT_EQ(next.machine.pin_spacing_mm, 1204.0);
  EXPECT_EQ(next.machine.zero_mm.left_mm, 0.0);
  EXPECT_EQ(next.machine.scale_mm_per_m.left_mm, 0.0);
  // Rounding of products of 80.
  EXPECT_NEAR(next.steps_per_mm.left, 80.08, 1e-12);
  EXPECT_NEAR(next.steps_per_mm.right, 79.84, 1e-12);
  // Counted at home are 1000 mm; the cords are (1000 - 5) / (1 + scale) long.
  ASSERT_TRUE(next.home);
  EXPECT_NEAR(std::hypot(next.home->x_mm + 602.0, next.home->y_mm), 995.0 / 1.001, 1e-8);
  EXPECT_NEAR(std::hypot(next.home->x_mm - 602.0, next.home->y_mm), 995.0 / 0.998, 1e-8);
  // A second time nothing changes.
  model::PlotterMachine sound = truth;
  sound.zero_mm = {};
  sound.scale_mm_per_m = {};
  EXPECT_EQ(once_typed_in(next, sound).steps_per_mm.left, next.steps_per_mm.left);
}

/// With its settings typed in, the fitted machine draws correctly, except for what the controller
/// cannot store.
TEST(SettingsToPaste, MakeTheMachineDrawAccurately) {
  model::PlotterMachine truth;
  truth.pin_spacing_mm = 1207.0;
  truth.pin_rise_mm = 5.0;
  truth.zero_mm = {8.0, -4.0};
  truth.scale_mm_per_m = {2.0, -1.0};
  const auto machine = model::make_plotter_mechanism(truth);
  const auto miss = [&](PlotterFirmware firmware) {
    const auto pen = pen_of_command(firmware, typed_in(firmware, truth), *machine, {150.0, -700.0});
    return std::hypot(pen->x_mm - 150.0, pen->y_mm + 700.0);
  };
  // A point on weightless straight cords is what FluidNC calculates.
  EXPECT_LT(miss(PlotterFirmware::fluidnc), 1e-8);
  EXPECT_GT(miss(PlotterFirmware::marlin), 0.1);  // 5 mm of rise over 1207 mm
}

}  // namespace
}  // namespace chaintrue::grid::plotter_paste_test
