// SPDX-License-Identifier: GPL-3.0-or-later
// Tables whose numbers are inches under a header that says mm: found out, and read by --inches.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::files {
namespace {
namespace inches_tests {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kInchMm = 25.4;
// A product and a quotient by 25.4 are each rounded once: two roundings of lengths up to 4 m, each
// below 5e-13 mm.
constexpr double kRoundingMm = 1e-12;

GridOptions on_a_machine(bool inches) {
  GridOptions options;
  options.machine = model::Machine{};
  options.inches = inches;
  return options;
}

/// Marks over the bed with exact lengths, or with commands at the marks, each divided by its own unit.
std::string table(bool commands, double measured_unit, double command_unit = 1.0) {
  const auto kinematics = model::make_kinematics(model::equilibrium_parameters(model::Machine{}));
  std::string text =
      commands ? "x_mm,y_mm,commanded_x_mm,commanded_y_mm\n" : "x_mm,y_mm,left_mm,right_mm\n";
  for (const double y : {-450.0, -50.0, 400.0}) {
    for (const double x : {-1000.0, -350.0, 300.0, 950.0}) {
      const auto pose = kinematics->inverse({x, y}).value();
      text += fmt::format("{},{},{},{}\n",
                          x / measured_unit,
                          y / measured_unit,
                          commands ? x / command_unit : pose.lengths.left_mm / measured_unit,
                          commands ? y / command_unit : pose.lengths.right_mm / measured_unit);
    }
  }
  return text;
}

std::string refusal_of(const std::string& text, bool inches = false) {
  try {
    (void)parse_grid(text, "t.csv", on_a_machine(inches));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TableInInches, SaidToBeSoItIsTheSameGrid) {
  for (const bool commands : {false, true}) {
    const MeasuredGrid mm = parse_grid(table(commands, 1.0), "t.csv", on_a_machine(false)).grid;
    const MeasuredGrid read =
        parse_grid(table(commands, kInchMm), "t.csv", on_a_machine(true)).grid;
    ASSERT_EQ(read.points.size(), mm.points.size());
    for (std::size_t i = 0; i < mm.points.size(); ++i) {
      EXPECT_NEAR(read.points[i].mark.x_mm, mm.points[i].mark.x_mm, kRoundingMm);
      EXPECT_NEAR(read.points[i].mark.y_mm, mm.points[i].mark.y_mm, kRoundingMm);
      ASSERT_EQ(read.points[i].lengths.has_value(), !commands);
      if (!commands) {
        EXPECT_NEAR(read.points[i].lengths->left_mm, mm.points[i].lengths->left_mm, kRoundingMm);
        EXPECT_NEAR(read.points[i].lengths->right_mm, mm.points[i].lengths->right_mm, kRoundingMm);
      } else {
        EXPECT_EQ(read.points[i].commanded->x_mm, mm.points[i].commanded->x_mm) << "commands stay in mm";
        EXPECT_EQ(read.points[i].commanded->y_mm, mm.points[i].commanded->y_mm);
      }
    }
  }
}

TEST(TableInInches, IsFoundOutAndTheOptionIsNamed) {
  EXPECT_THAT(refusal_of(table(false, kInchMm)),
              HasSubstr("these look like inches: multiply all of them by 25.4, or say --inches"));
  EXPECT_THAT(refusal_of(table(true, kInchMm)),
              HasSubstr("multiply x_mm and y_mm by 25.4, or say --inches"));
  // Said already, it is not named again.
  EXPECT_THAT(refusal_of(table(true, kInchMm * kInchMm), true),
              AllOf(HasSubstr("look like inches"), Not(HasSubstr("--inches"))));
}

TEST(TableInInches, OfATableWithoutAMachineToo) {
  try {
    (void)parse_grid(table(false, kInchMm), "t.csv");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("multiply all of them by 25.4, or say --inches"));
  }
}

TEST(TableInInches, JsonIsAsItsKeysSay) {
  MeasuredGrid grid = parse_grid(table(false, 1.0), "t.csv", on_a_machine(false)).grid;
  for (MeasuredPoint& point : grid.points) {
    point.mark = {point.mark.x_mm / kInchMm, point.mark.y_mm / kInchMm};
    point.lengths = {point.lengths->left_mm / kInchMm, point.lengths->right_mm / kInchMm};
  }
  grid.machine.reset();
  for (const bool inches : {false, true}) {
    EXPECT_THAT(refusal_of(write_grid(grid), inches),
                AllOf(HasSubstr("look like inches"), Not(HasSubstr("--inches"))));
  }
}

TEST(TableInInches, ACellsOwnUnitAndAFractionStandAsTheyAre) {
  GridOptions options = on_a_machine(true);
  options.machine.reset();
  options.fewest_points = 1;
  const auto points = parse_grid(
                          "x_mm,y_mm,left_mm,right_mm,order\n"
                          "43 13/16,-20,\"2541.5 mm\",2 m,3\n",
                          "t.csv",
                          options)
                          .grid.points;
  ASSERT_EQ(points.size(), 1U);
  EXPECT_DOUBLE_EQ(points[0].mark.x_mm, 1112.8375);
  EXPECT_DOUBLE_EQ(points[0].mark.y_mm, -508.0);
  EXPECT_DOUBLE_EQ(points[0].lengths->left_mm, 2541.5);
  EXPECT_DOUBLE_EQ(points[0].lengths->right_mm, 2000.0);
  EXPECT_EQ(points[0].order, 3);
}

TEST(TableInInches, ANumberOutOfRangeIsGivenInBothUnits) {
  EXPECT_THAT(refusal_of("x_mm,y_mm,left_mm,right_mm\n1000,0,100,100\n", true),
              HasSubstr("1000 (25400 mm)"));
  EXPECT_THAT(refusal_of("x_in,y_mm,left_mm,right_mm\n1000,0,100,100\n"),
              HasSubstr("1000 (25400 mm)"));
}

TEST(TableInInches, OfHolesTheDistancesAreMeant) {
  const std::string holes = "hole,x_mm,y_mm\nA,-900,400\nB,900,400\nC,900,-400\nD,-900,-400\n";
  const std::string text = holes +
                           "from,to,distance_mm\nA,B,70 7/8\nB,C,31.5\nC,D,70.8\nD,A,31.5\n"
                           "A,C,77.5\nB,D,77.5\n";
  HolesOptions options;
  options.machine = model::Machine{};
  try {
    (void)parse_holes(text, "t.csv", options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("multiply the distances by 25.4, or say --inches"));
  }
  options.inches = true;
  const MeasuredHoles read = parse_holes(text, "t.csv", options).holes;
  EXPECT_EQ(read.holes.front().commanded.x_mm, -900.0);
  EXPECT_EQ(read.holes.front().commanded.y_mm, 400.0);
  EXPECT_DOUBLE_EQ(read.distances[0].distance_mm, 70.875 * kInchMm);
  EXPECT_DOUBLE_EQ(read.distances[1].distance_mm, 31.5 * kInchMm);
}

}  // namespace inches_tests
}  // namespace
}  // namespace chaintrue::grid::files
