// SPDX-License-Identifier: GPL-3.0-or-later
// An error is where the tool landed minus where it was sent: a tool that hangs low has an error that points down.
#include <gtest/gtest.h>

#include "grid/map/fit.hpp"
#include "grid/map/map_for_settings.hpp"
#include "model/controllers/payout.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue::grid {
namespace {

constexpr double kLowMm = 10.0;

/// 28 commands of a machine whose motors, and so its tool, are lower than its settings say.
MeasuredGrid grid_of_a_tool_that_hangs_low() {
  model::Machine machine;
  machine.controller.kind = model::ControllerKind::maslow_classic;
  machine.controller.settings.bed_width_mm = machine.bed.width_mm;
  machine.controller.settings.bed_height_mm = machine.bed.height_mm;
  MeasuredGrid grid;
  grid.machine = machine;
  grid.noise = StatedNoise{0.1, 0.1, 15.0};
  for (const model::BedPoint& sent : testing_support::commands(7, 4))
    grid.points.push_back({{sent.x_mm, sent.y_mm - kLowMm}, std::nullopt, sent, std::nullopt});
  return grid;
}

TEST(ToolError, PointsDownWhereTheToolHangsLow) {
  const auto map = fit(grid_of_a_tool_that_hangs_low());
  ASSERT_TRUE(map) << map.error().sentence();
  // Newton of the controller's formulas: 1e-9 mm, and a few roundings of metres.
  constexpr double kRoundingMm = 1e-6;
  for (const MapPoint& point : map->contents().points) {
    EXPECT_NEAR(point.as_stated_mm.x(), 0.0, kRoundingMm);
    EXPECT_NEAR(point.as_stated_mm.y(), -kLowMm, kRoundingMm);
  }
  const CompensationMap same = map_for_settings(*map, stated_machine(*map)->controller, "");
  for (const MapPoint& point : same.contents().points)
    EXPECT_NEAR(point.as_stated_mm.y(), -kLowMm, kRoundingMm);
}

TEST(ToolError, PointsFromALeftOutPointToItsTypedPlace) {
  MeasuredGrid grid = grid_of_a_tool_that_hangs_low();
  constexpr std::size_t kMiddle = 10;
  grid.points[kMiddle].mark.y_mm -= 3.0;
  const auto map = fit(grid);
  ASSERT_TRUE(map) << map.error().sentence();
  // Its neighbours lie 3 mm higher; the surface between them is off by far less than 1 mm.
  EXPECT_NEAR(map->contents().points[kMiddle].left_out_mm.y(), -3.0, 1.0);
}

}  // namespace
}  // namespace chaintrue::grid
