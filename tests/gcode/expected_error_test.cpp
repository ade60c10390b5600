// SPDX-License-Identifier: GPL-3.0-or-later
// A map's error along the cuts, on maps whose error is a formula.
#include "tools/gcode/expected_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/gcode/formula_target.hpp"

namespace chaintrue::gcode {
namespace {

/// 0.1 mm on the left half, 0.3 on the right; nothing was measured above 500 mm.
class HalvesMap final : public StubMap {
 public:
  HalvesMap() : StubMap({-1e4, 1e4, -1e4, 1e4}) {}
  [[nodiscard]] tl::expected<model::ChainLengths, grid::MapFailure> lengths(
      model::BedPoint p) const override {
    return model::ChainLengths{p.x_mm, p.y_mm};
  }
  [[nodiscard]] tl::expected<grid::LengthsAnswer, grid::MapFailure> query(
      model::BedPoint p) const override {
    return grid::LengthsAnswer{
        Eigen::Vector2d(p.x_mm, p.y_mm), {}, p.x_mm < 0.0 ? 0.1 : 0.3, status(p)};
  }
  Eigen::Matrix2Xd tool_spread(model::BedPoint p) const override {
    return Eigen::Vector2d(p.x_mm < 0.0 ? 0.1 : 0.3, 0.0);
  }
  [[nodiscard]] grid::MapStatus status(model::BedPoint p) const override {
    return p.y_mm > 500.0 ? grid::MapStatus::extrapolated : grid::MapStatus::inside;
  }
  [[nodiscard]] tl::expected<model::BedPoint, grid::MapFailure> tool(
      model::ChainLengths l) const override {
    return model::BedPoint{l.left_mm, l.right_mm};
  }
};

Move feed(Point from, Point to, std::size_t line) {
  Move move;
  move.kind = MoveKind::feed;
  move.line = line;
  move.from = from;
  move.to = to;
  move.names_xy = true;
  return move;
}

constexpr double kRounding = 1e-12;

TEST(ExpectedError, CountsEachMillimetreOfACutOnce) {
  CutPlaces cuts;
  cuts.add(feed({-100, 10, -3}, {100, 10, -3}, 4));
  const auto error = cuts.expected(HalvesMap{});
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->measured.length_mm, 200.0, 200.0 * kRounding);
  EXPECT_NEAR(error->measured.rms_mm, std::sqrt(0.5 * (0.01 + 0.09)), kRounding);
  // 1.96 sigmas of one direction; four sigmas of the quantile of 400 draws are 0.37 of one.
  EXPECT_NEAR(error->measured.largest_mm, 0.3 * 1.96, 0.3 * 0.37);
  EXPECT_EQ(error->measured.weakest_line, 4U);
  EXPECT_EQ(error->outside.length_mm, 0.0);
}

TEST(ExpectedError, CutIntoPiecesIsTheSame) {
  CutPlaces whole;
  CutPlaces pieces;
  whole.add(feed({-90, 10, -3}, {110, 10, -3}, 1));
  for (int i = 0; i < 1000; ++i)
    pieces.add(feed({-90 + 0.2 * i, 10, -3}, {-90 + 0.2 * (i + 1), 10, -3}, 1));
  // A piece may fall half into a square of 20 mm where the whole one's pieces do not.
  EXPECT_NEAR(whole.expected(HalvesMap{})->measured.rms_mm,
              pieces.expected(HalvesMap{})->measured.rms_mm, 0.01);
}

TEST(ExpectedError, ListsUnmeasuredPartsSeparately) {
  CutPlaces cuts;
  cuts.add(feed({-100, 300, -3}, {-100, 400, -3}, 2));
  cuts.add(feed({100, 520, -3}, {150, 520, -3}, 3));
  const auto error = cuts.expected(HalvesMap{});
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->measured.rms_mm, 0.1, kRounding);
  EXPECT_NEAR(error->outside.length_mm, 50.0, 50.0 * kRounding);
  EXPECT_NEAR(error->outside.rms_mm, 0.3, kRounding);
  EXPECT_EQ(error->outside.weakest_line, 3U);
}

TEST(ExpectedError, CountsArcsAndPlungesAsCutsButNotRapids) {
  CutPlaces cuts;
  Move circle = feed({-150, 0, -3}, {-150, 0, -3}, 1);
  circle.kind = MoveKind::arc;
  circle.arc = Arc{};
  circle.arc->centre = {-200, 0, -3};
  circle.arc->start_radius_mm = circle.arc->end_radius_mm = 50.0;
  circle.arc->sweep_rad = 2.0 * std::numbers::pi;
  circle.arc->start_height_mm = circle.arc->end_height_mm = 0.0;
  cuts.add(circle);
  // Chords of a quarter of a radian are shorter than their arcs by (1/4)^2 / 24.
  const double around = 100.0 * std::numbers::pi;
  EXPECT_NEAR(cuts.expected(HalvesMap{})->measured.length_mm, around, 0.0027 * around);
  CutPlaces others;
  Move rapid = feed({0, 0, 5}, {300, 0, 5}, 2);
  rapid.kind = MoveKind::rapid;
  others.add(rapid);
  EXPECT_EQ(others.expected(HalvesMap{})->measured.length_mm, 0.0);
  Move plunge = feed({300, 0, 5}, {300, 0, -2}, 3);
  plunge.names_xy = false;
  others.add(plunge);
  EXPECT_GT(others.expected(HalvesMap{})->measured.length_mm, 0.0);
  EXPECT_EQ(others.expected(HalvesMap{})->measured.rms_mm, 0.3);
}

TEST(ExpectedError, IsAbsentIfTheMapHasNone) {
  CutPlaces cuts;
  cuts.add(feed({0, 0, 0}, {10, 0, 0}, 1));
  const FormulaMap plain([](model::BedPoint) { return model::BedPoint{}; });
  EXPECT_FALSE(cuts.expected(plain));
}

}  // namespace
}  // namespace chaintrue::gcode
