// SPDX-License-Identifier: GPL-3.0-or-later
/// A plotter's controller there and back, its map against the mechanism, and its pieces.
#include "model/plotter/plotter_commands.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grid/plotter/plotter_map.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid::plotter_test {
namespace {

using model::BedPoint;
using model::PlotterController;
using model::PlotterFirmware;
using model::PlotterMachine;

PlotterMachine machine_of(PlotterFirmware firmware) {
  PlotterMachine machine =
      firmware == PlotterFirmware::mural ? model::mural(1400.0) : PlotterMachine{};
  if (firmware == PlotterFirmware::fluidnc) machine.pin_rise_mm = 9.0;
  machine.zero_mm = {12.0, -7.0};
  machine.scale_mm_per_m = {2.0, -3.0};
  return machine;
}

TEST(PlotterController, CommandsRoundTrip) {
  for (const PlotterFirmware firmware : model::kPlotterFirmwares) {
    SCOPED_TRACE(name(firmware));
    const PlotterMachine machine = machine_of(firmware);
    const BedPoint middle{310.0, 220.0};
    const PlotterController controller(firmware, machine, middle);
    Random random(5, 3);
    for (int i = 0; i < 200; ++i) {
      const model::DrawingArea& area = machine.area;
      const BedPoint command{
          middle.x_mm + area.left_mm + (area.right_mm - area.left_mm) * random.uniform(),
          middle.y_mm + area.bottom_mm + (area.top_mm - area.bottom_mm) * random.uniform()};
      const auto lengths = controller.lengths(command);
      ASSERT_TRUE(lengths) << command.x_mm << " " << command.y_mm;
      const auto back = controller.command(*lengths);
      ASSERT_TRUE(back) << back.error().sentence();
      // Newton stops below 1e-9 mm; near the pins a length bends by more than it changes.
      EXPECT_NEAR(back->x_mm, command.x_mm, 1e-7);
      EXPECT_NEAR(back->y_mm, command.y_mm, 1e-7);
    }
    EXPECT_FALSE(controller.command({100.0, 100.0}));                     // cords that do not meet
    EXPECT_FALSE(controller.lengths({middle.x_mm, middle.y_mm + 10.0}));  // above the pins
  }
}

KnownPlotter known_plotter() {
  KnownPlotter plotter;
  plotter.set.firmware = PlotterFirmware::marlin;
  plotter.set.home = BedPoint{0.0, -700.0};
  plotter.set.pins_middle = {600.0, 800.0};
  plotter.found = FoundPlotter{{1204.0, 0.6},
                               {5.0, 2.0},
                               {8.0, 0.7},
                               {-3.0, 0.7},
                               {1.0, 0.3},
                               {0.5, 0.3},
                               std::vector<double>(15, 0.0)};
  return plotter;
}

TEST(PlotterMap, EqualsTheFittedPlotterOnItsPage) {
  const KnownPlotter plotter = known_plotter();
  const MechanismMap map = plotter_map(plotter);
  const auto mechanism = model::make_plotter_mechanism(machine_found(plotter.set, *plotter.found));
  const PlotterController controller(plotter.set.firmware, plotter.set.machine,
                                     plotter.set.pins_middle);
  // On average the crosses are drawn where they were commanded.
  double x = 0.0, y = 0.0, worst = 0.0;
  const TestDrawing drawing = planned_drawing(plotter.set);
  for (const DrawnCross& cross : drawing.crosses) {
    const BedPoint command{cross.commanded.x_mm + 600.0, cross.commanded.y_mm + 800.0};
    const auto counted = controller.lengths(command);
    ASSERT_TRUE(counted);
    const auto tool = map.tool(*counted);
    ASSERT_TRUE(tool);
    x += tool->x_mm - command.x_mm;
    y += tool->y_mm - command.y_mm;
    worst = std::max(worst, std::hypot(tool->x_mm - command.x_mm, tool->y_mm - command.y_mm));
    const auto lengths = map.lengths(command);
    ASSERT_TRUE(lengths);
    const auto back = map.tool(*lengths);
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->x_mm, command.x_mm, 1e-6);
    EXPECT_NEAR(back->y_mm, command.y_mm, 1e-6);
    EXPECT_EQ(map.status(command), MapStatus::inside);
  }
  EXPECT_NEAR(x, 0.0, 1e-6);
  EXPECT_NEAR(y, 0.0, 1e-6);
  EXPECT_GT(worst, 1.0);
  // The page is moved, not turned.
  const auto above = mechanism->locate_by_first({900.0, 900.0});
  const auto on_page = map.tool({900.0, 900.0});
  const auto beside = mechanism->locate_by_first({950.0, 900.0});
  const auto beside_on_page = map.tool({950.0, 900.0});
  ASSERT_TRUE(above && on_page && beside && beside_on_page);
  EXPECT_NEAR(beside->x_mm - above->x_mm, beside_on_page->x_mm - on_page->x_mm, 1e-9);
  EXPECT_NEAR(beside->y_mm - above->y_mm, beside_on_page->y_mm - on_page->y_mm, 1e-9);
}

TEST(PlotterMap, KnowsItsErrorOfShapeAndNotOfPlace) {
  KnownPlotter plotter = known_plotter();
  // A rise of the pins rotates a point's whole drawing, which is not an error of its shape.
  plotter.found->pin_spacing_mm.sigma = plotter.found->zero_left_mm.sigma = 0.0;
  plotter.found->zero_right_mm.sigma = plotter.found->scale_left_mm_per_m.sigma = 0.0;
  plotter.found->scale_right_mm_per_m.sigma = 0.0;
  const auto turned = plotter_map(plotter).query({600.0, 100.0});
  ASSERT_TRUE(turned);
  ASSERT_TRUE(turned->tool_sigma_mm);
  EXPECT_LT(*turned->tool_sigma_mm, 0.02);  // 2 mm of rise on 1204 turn by 1.7 mrad
  // Off the drawing area there is no answer; nor without a drawing.
  EXPECT_FALSE(plotter_map(plotter).query({600.0, 900.0}));
  plotter.found.reset();
  EXPECT_THROW((void)plotter_map(plotter), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid::plotter_test
