// SPDX-License-Identifier: GPL-3.0-or-later
// The search for how numbers were meant, on marks of random machines: each transformation of all
// rows, of those from one on and of a column is reported, with its first row; sound grids are
// accepted.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/input_checks/point_checks.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid::input_checks {
namespace {

using model::MarkPoint;

constexpr std::size_t kRows = 30;

/// Marks 5 x 6 in rows from below, with a machine error of some millimetres and noise of 0.4 mm.
MeasuredGrid sound_grid(std::uint64_t seed) {
  Random random(seed, 7);
  MeasuredGrid grid;
  grid.machine = model::Machine{};
  grid.machine->controller.kind = model::ControllerKind::ideal;
  const auto uniform = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
  const double x_mm = uniform(5.0), y_mm = uniform(5.0), slope = uniform(3.0), bend = uniform(5.0);
  for (std::size_t i = 0; i < kRows; ++i) {
    const double u = -1.0 + 2.0 * static_cast<double>(i % 5) / 4.0;
    const double v = -1.0 + 2.0 * static_cast<double>(i / 5) / 5.0;
    MeasuredPoint point;
    point.commanded = model::BedPoint{std::round(1080.0 * u), std::round(500.0 * v)};
    point.mark = {point.commanded->x_mm + x_mm + slope * u + 0.4 * random.normal(),
                  point.commanded->y_mm + y_mm + bend * u * u + 0.4 * random.normal()};
    point.order = static_cast<int>(i) + 1;
    grid.points.push_back(point);
  }
  return grid;
}

/// What is written: x = xx x + xy y + x0, and so for y.
struct Slip {
  const char* name;
  ProblemKind kind;
  double xx, xy, x0, yx, yy, y0;
  bool of_all = true;
};

// The bed is 2438.4 by 1219.2 mm; the left motor is at (-1489.2, 1072.6).
constexpr double kPerMm = 1.0 / 25.4;
const Slip kSlips[] = {
    {"y from the upper edge down", ProblemKind::constant_offset, 1, 0, 0, 0, -1, 609.6},
    {"y from the upper edge", ProblemKind::constant_offset, 1, 0, 0, 0, 1, -609.6},
    {"from the left motor down", ProblemKind::constant_offset, 1, 0, 1489.2, 0, -1, 1072.6},
    {"from the lower right corner leftwards", ProblemKind::constant_offset, -1, 0, 1219.2, 0, 1,
     609.6},
    {"inches", ProblemKind::other_unit, kPerMm, 0, 0, 0, kPerMm, 0},
    {"x in inches", ProblemKind::other_unit, kPerMm, 0, 0, 0, 1, 0},
    {"columns exchanged", ProblemKind::axes, 0, 1, 0, 1, 0, 0},
    {"y downwards", ProblemKind::axes, 1, 0, 0, 0, -1, 0},
    {"an inch more in y", ProblemKind::constant_offset, 1, 0, 0, 0, 1, 25.4, false},
    {"the tape's 100 mm mark in x", ProblemKind::constant_offset, 1, 0, 100, 0, 1, 0}};

TEST(Transformations, AreNamedForAllRowsAndForATail) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const MeasuredGrid sound = sound_grid(seed);
    EXPECT_FALSE(check_points(sound).whole)
        << "seed " << seed << ": " << check_points(sound).whole->sentence();
    for (const Slip& slip : kSlips) {
      // The middle of the list, and a place where no row of marks begins.
      for (const std::size_t from : {std::size_t{0}, kRows / 2, kRows / 2 + 2}) {
        if (from == 0 && !slip.of_all) continue;
        SCOPED_TRACE(testing::Message() << slip.name << " from " << from << ", seed " << seed);
        MeasuredGrid spoilt = sound;
        for (std::size_t i = from; i < kRows; ++i) {
          MarkPoint& m = spoilt.points[i].mark;
          m = {slip.xx * m.x_mm + slip.xy * m.y_mm + slip.x0,
               slip.yx * m.x_mm + slip.yy * m.y_mm + slip.y0};
        }
        const auto found = check_points(spoilt).whole;
        ASSERT_TRUE(found);
        EXPECT_EQ(found->kind, slip.kind) << found->sentence();
        ASSERT_EQ(found->from_row.has_value(), from != 0) << found->sentence();
        // A mark that reads the same either way may be on either side.
        if (from != 0) {
          EXPECT_NEAR(static_cast<double>(*found->from_row), static_cast<double>(from), 1.0)
              << found->sentence();
        }
      }
    }
  }
}

TEST(Transformations, DistinguishATurnedSheetFromSkewedAxes) {
  constexpr double kRad = 0.015;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    MeasuredGrid turned = sound_grid(seed), skew = turned;
    for (std::size_t i = 0; i < kRows; ++i) {
      const MarkPoint m = turned.points[i].mark;
      turned.points[i].mark = {m.x_mm - kRad * m.y_mm, m.y_mm + kRad * m.x_mm};
      skew.points[i].mark = {m.x_mm, m.y_mm + kRad * m.x_mm};
    }
    const auto found = check_points(turned).whole;
    ASSERT_TRUE(found) << "seed " << seed;
    EXPECT_EQ(found->kind, ProblemKind::axes);
    EXPECT_TRUE(found->is_doubtful);
    EXPECT_FALSE(check_points(skew).whole) << "seed " << seed;
  }
}

}  // namespace
}  // namespace chaintrue::grid::input_checks
