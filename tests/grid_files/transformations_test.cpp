// SPDX-License-Identifier: GPL-3.0-or-later
// The search for how numbers were meant, on marks of random machines: each transformation of all
// rows, of those from one on and of a column is reported, with its first row; sound grids are
// accepted.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "grid/input_checks/point_checks.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid::input_checks {
namespace {

using model::MarkPoint;

constexpr double kMmPerInchOfTests = 25.4;
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

struct Slip {
  const char* name;
  std::function<MarkPoint(MarkPoint, const model::Machine&)> written;
  ProblemKind kind;
  bool of_all = true;
};

const Slip kSlips[] = {
    {"y from the upper edge down",
     [](MarkPoint m, const model::Machine& machine) {
       return MarkPoint{m.x_mm, 0.5 * machine.bed.height_mm - m.y_mm};
     },
     ProblemKind::constant_offset},
    {"y from the upper edge",
     [](MarkPoint m, const model::Machine& machine) {
       return MarkPoint{m.x_mm, m.y_mm - 0.5 * machine.bed.height_mm};
     },
     ProblemKind::constant_offset},
    {"from the left motor down",
     [](MarkPoint m, const model::Machine& machine) {
       return MarkPoint{m.x_mm - machine.motors.left.x_mm, machine.motors.left.y_mm - m.y_mm};
     },
     ProblemKind::constant_offset},
    {"from the lower right corner leftwards",
     [](MarkPoint m, const model::Machine& machine) {
       return MarkPoint{0.5 * machine.bed.width_mm - m.x_mm, m.y_mm + 0.5 * machine.bed.height_mm};
     },
     ProblemKind::constant_offset},
    {"inches",
     [](MarkPoint m, const model::Machine&) {
       return MarkPoint{m.x_mm / kMmPerInchOfTests, m.y_mm / kMmPerInchOfTests};
     },
     ProblemKind::other_unit},
    {"x in inches",
     [](MarkPoint m, const model::Machine&) {
       return MarkPoint{m.x_mm / kMmPerInchOfTests, m.y_mm};
     },
     ProblemKind::other_unit},
    {"columns exchanged",
     [](MarkPoint m, const model::Machine&) {
       return MarkPoint{m.y_mm, m.x_mm};
     },
     ProblemKind::axes},
    {"y downwards",
     [](MarkPoint m, const model::Machine&) {
       return MarkPoint{m.x_mm, -m.y_mm};
     },
     ProblemKind::axes},
    {"an inch more in y",
     [](MarkPoint m, const model::Machine&) {
       return MarkPoint{m.x_mm, m.y_mm + kMmPerInchOfTests};
     },
     ProblemKind::constant_offset,
     false},
    {"the tape's 100 mm mark in x",
     [](MarkPoint m, const model::Machine&) {
       return MarkPoint{m.x_mm + 100.0, m.y_mm};
     },
     ProblemKind::constant_offset}};

TEST(Transformations, AreNamedForAllRowsAndForATail) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const MeasuredGrid sound = sound_grid(seed);
    EXPECT_FALSE(check_points(sound).whole) << "seed " << seed << ": " << check_points(sound).whole->sentence();
    for (const Slip& slip : kSlips) {
      // The middle of the list, and a place where no row of marks begins.
      for (const std::size_t from : {std::size_t{0}, kRows / 2, kRows / 2 + 2}) {
        if (from == 0 && !slip.of_all) continue;
        MeasuredGrid spoilt = sound;
        for (std::size_t i = from; i < kRows; ++i)
          spoilt.points[i].mark = slip.written(spoilt.points[i].mark, *sound.machine);
        const auto found = check_points(spoilt).whole;
        ASSERT_TRUE(found) << slip.name << " from " << from << ", seed " << seed;
        EXPECT_EQ(found->kind, slip.kind) << slip.name << " from " << from << ", seed " << seed << ": "
                                          << found->sentence();
        if (from == 0) {
          EXPECT_FALSE(found->from_row) << slip.name << ", seed " << seed << ": " << found->sentence();
        } else {
          // A mark that reads the same either way may be on either side.
          ASSERT_TRUE(found->from_row) << slip.name << ", seed " << seed << ": " << found->sentence();
          EXPECT_NEAR(static_cast<double>(*found->from_row), static_cast<double>(from), 1.0)
              << slip.name << ", seed " << seed << ": " << found->sentence();
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
