// SPDX-License-Identifier: GPL-3.0-or-later
/// The best straight lines for a map: their error, recomputed from the map's tool, and that no
/// other lines have less.
#include "grid/map/straight_settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "grid/map/controller_error.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/map_in_frame.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue::grid {
namespace {

using testing_support::sagging_map;

/// The tool's position by the map when a straight-line controller that was switched on at 0, 0 is
/// sent to the measured places: rms of the distances from these, with the map's uncertainty.
double tool_rms_mm(const CompensationMap& map, const StraightSettings& s) {
  const MapInFrame in_frame(map);
  const auto origin = in_frame.lengths({0.0, 0.0});
  EXPECT_TRUE(origin);
  double sum = 0.0;
  int count = 0;
  for (const MeasuredPlace& place : measured_places(map, MapFrame::marks)) {
    if (place.is_on_edge) continue;
    model::ChainLengths paid;
    for (const model::Side side : model::kSides) {
      const model::BedPoint a = s.anchors[side];
      paid[side] = (*origin)[side] +
                   s.more_steps[side] *
                       (std::hypot(place.commanded.x_mm - a.x_mm, place.commanded.y_mm - a.y_mm) -
                        std::hypot(a.x_mm, a.y_mm));
    }
    const auto tool = in_frame.tool(paid);
    EXPECT_TRUE(tool);
    sum += std::pow(tool->x_mm - place.commanded.x_mm, 2) +
           std::pow(tool->y_mm - place.commanded.y_mm, 2) + place.spread_mm.squaredNorm();
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(StraightSettings, LeaveTheErrorTheyReport) {
  for (const Anchors anchors : {Anchors::free, Anchors::level}) {
    const auto nearest = straight_settings(sagging_map(), anchors);
    ASSERT_TRUE(nearest) << nearest.error().sentence();
    const double rms = tool_rms_mm(sagging_map(), *nearest);
    // The stated error is first order: a millimetre is wrong by a micrometre.
    EXPECT_NEAR(nearest->left_over.rms_mm, rms, 2e-3 * rms + 2e-3);
    EXPECT_GE(nearest->left_over.maximum_mm, nearest->left_over.rms_mm);
  }
}

TEST(StraightSettings, AreOptimal) {
  const auto nearest = straight_settings(sagging_map(), Anchors::free);
  ASSERT_TRUE(nearest);
  const double least = tool_rms_mm(sagging_map(), *nearest);
  const std::function<double&(StraightSettings&)> unknowns[] = {
      [](StraightSettings& s) -> double& { return s.anchors.left.x_mm; },
      [](StraightSettings& s) -> double& { return s.anchors.left.y_mm; },
      [](StraightSettings& s) -> double& { return s.anchors.right.x_mm; },
      [](StraightSettings& s) -> double& { return s.anchors.right.y_mm; },
      [](StraightSettings& s) -> double& { return s.more_steps.left; },
      [](StraightSettings& s) -> double& { return s.more_steps.right; }};
  for (std::size_t i = 0; i < std::size(unknowns); ++i) {
    for (const double sign : {-1.0, 1.0}) {
      StraightSettings other = *nearest;
      unknowns[i](other) += sign * (i < 4 ? 1.0 : 1e-3);
      EXPECT_GT(tool_rms_mm(sagging_map(), other), least) << i << " " << sign;
    }
  }
  // Fewer numbers cannot fit better.
  const auto level = straight_settings(sagging_map(), Anchors::level);
  ASSERT_TRUE(level);
  EXPECT_EQ(level->anchors.left.y_mm, level->anchors.right.y_mm);
  EXPECT_GE(tool_rms_mm(sagging_map(), *level), least - 1e-9);
}

}  // namespace
}  // namespace chaintrue::grid
