// SPDX-License-Identifier: GPL-3.0-or-later
// The list written by plan, blank: every verb that accepts measurements reads it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing_support::content_of;
using testing_support::Outcome;
using testing_support::without_origin;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream rest(line + ",");
  for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(cell);
  return cells;
}

class SheetOfPlan : public testing_support::CommandFixture {
 protected:
  /// The list filled in for a tool with errors of some tenths; every `blank`-th line is left blank
  /// (0: none).
  [[nodiscard]] std::string filled(const std::string& list, int blank, char separator = ',') const {
    std::istringstream lines(content_of(folder_ / list));
    std::string text;
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::vector<std::string> cells = cells_of(line);
      if (!line.empty() && std::isdigit(static_cast<unsigned char>(line.front())) != 0) {
        ++number;
        const double x = std::stod(cells[1]);
        const double y = std::stod(cells[2]);
        if (blank == 0 || number % blank != 0) {
          line = fmt::format("{},{},{},{:.1f},{:.1f}",
                             cells[0],
                             cells[1],
                             cells[2],
                             x + 0.001 * y + 0.4,
                             y + 0.3 + 2e-7 * x * x);
        }
      }
      if (separator == ';') {
        for (char& c : line) c = c == ',' ? ';' : c == '.' ? ',' : c;
      }
      text += line + "\n";
    }
    return text;
  }

  const std::string machine_ = std::string(CHAINTRUE_FIXTURES) + "/machines/groundcontrol.json";
  const std::string classic_ = std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json";
};

TEST_F(SheetOfPlan, IsBlankAndAsksForPlacesWhereAControllerIsNamed) {
  ASSERT_EQ(run("plan --machine " + machine_ + " -o marks.csv").code, 0);
  EXPECT_THAT(content_of(folder_ / "marks.csv"),
              StartsWith("order,commanded_x_mm,commanded_y_mm,x_mm,y_mm\n1,-1119,-509,,\n"));
  ASSERT_EQ(run("plan --machine " + machine_ + " --measure lengths -o lengths.csv").code, 0);
  EXPECT_THAT(content_of(folder_ / "lengths.csv"),
              StartsWith("order,x_mm,y_mm,left_mm,right_mm\n1,-1119,-509,,\n"));
}

TEST_F(SheetOfPlan, LeftBlankMakesNoMap) {
  for (const std::string name : {"marks.csv", "marks.json"}) {
    ASSERT_EQ(run("plan --machine " + machine_ + " -o " + name).code, 0);
    const Outcome fit = run("fit " + name + " --machine " + machine_ + " -o map.json");
    EXPECT_EQ(fit.code, 3);
    EXPECT_THAT(fit.err,
                AllOf(HasSubstr("found 28 points, all left blank"),
                      HasSubstr("written into the empty columns")));
  }
  for (const std::string name : {"holes.csv", "holes.json"}) {
    ASSERT_EQ(run("plan --machine " + machine_ + " --holes 9 -o " + name).code, 0);
    const Outcome fit = run("fit " + name + " --machine " + machine_ + " -o map.json");
    EXPECT_EQ(fit.code, 3);
    EXPECT_THAT(fit.err, HasSubstr("found 20 distances, all left blank"));
  }
  EXPECT_FALSE(exists("map.json"));
}

TEST_F(SheetOfPlan, FilledInIsReadAsItIs) {
  ASSERT_EQ(run("plan --machine " + machine_ + " -o marks.csv").code, 0);
  write("filled.csv", filled("marks.csv", 7));
  const std::string noise = " --noise-length-mm 0.1 --noise-position-mm 0.3";
  const Outcome fit = run("fit filled.csv --machine " + machine_ + noise + " -o map.json");
  EXPECT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr("4 of 28 points are left blank and left out: 7, 14, 21, 28\n"));
  EXPECT_THAT(fit.err, HasSubstr("Your machine misses by about"));
  EXPECT_THAT(fit.err, Not(HasSubstr("Were they measured?")));
  const Outcome diagnose =
      run("diagnose filled.csv --machine " + machine_ + noise + " -o diagnosis.json");
  EXPECT_EQ(diagnose.code, 0) << diagnose.err;
  ASSERT_EQ(run("plan --check map.json -o five.csv").code, 0);
  write("five_filled.csv", filled("five.csv", 5));
  const Outcome check = run("check map.json five_filled.csv");
  EXPECT_NE(check.code, 3) << check.err;
  EXPECT_THAT(check.err, HasSubstr("1 of 5 points are left blank and left out: 5"));
}

TEST_F(SheetOfPlan, OfAEuropeanSpreadsheetIsTheSame) {
  ASSERT_EQ(run("plan --machine " + machine_ + " -o marks.csv").code, 0);
  write("points.csv", filled("marks.csv", 0));
  write("semicolons.csv", filled("marks.csv", 0, ';'));
  for (const std::string name : {"points", "semicolons"}) {
    const Outcome fit = run("fit " + name + ".csv --machine " + machine_ + " -o " + name + ".json");
    ASSERT_EQ(fit.code, 0) << fit.err;
  }
  EXPECT_EQ(without_origin(content_of(folder_ / "points.json")),
            without_origin(content_of(folder_ / "semicolons.json")));
}

TEST_F(SheetOfPlan, CopiedExpectationsAreAskedAbout) {
  ASSERT_EQ(run("plan --machine " + classic_ + " --holes 9 -o holes.csv").code, 0);
  std::istringstream lines(content_of(folder_ / "holes.csv"));
  std::string copied;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells = cells_of(line);
    const bool distance = cells.size() == 4 && cells[2].empty();
    copied += (distance ? cells[0] + "," + cells[1] + "," + cells[3] + "," : line) + "\n";
  }
  write("copied.csv", copied);
  const Outcome fit = run("fit copied.csv --machine " + classic_ + " -o map.json");
  EXPECT_THAT(fit.err,
              HasSubstr("all 20 distances read exactly as commanded. Were they measured?"));
}

TEST_F(SheetOfPlan, HalfAReadingIsReported) {
  write("half.csv",
        "x_mm,y_mm,commanded_x_mm,commanded_y_mm\n-900,-400,-900,-400\n900,,900,-400\n");
  const Outcome fit = run("fit half.csv --machine " + machine_ + " -o map.json");
  EXPECT_EQ(fit.code, 3);
  EXPECT_THAT(fit.err,
              HasSubstr("line 3, column 5: missing, expected a number in mm from -20000 to 20000 "
                        "(y_mm), or both left blank"));
}

TEST_F(SheetOfPlan, ManySlipsOfOneKindAreCounted) {
  std::string text = "x_mm,y_mm,left_mm,right_mm\n";
  for (int i = 0; i < 101; ++i) text += "a,1,1000,1000\n";
  write("slips.csv", text);
  const Outcome fit = run("fit slips.csv --machine " + classic_ + " -o map.json");
  EXPECT_EQ(fit.code, 3);
  EXPECT_EQ(std::count(fit.err.begin(), fit.err.end(), '\n'), 6);
  EXPECT_THAT(fit.err, HasSubstr("found 96 more like these, expected a number in mm"));
}

TEST_F(SheetOfPlan, ProgramsDriveToTheMarksInTheirOrder) {
  ASSERT_EQ(run("plan --machine " + machine_ + " -o marks.csv --gcode marks.nc").code, 0);
  const std::string drill = content_of(folder_ / "marks.nc");
  EXPECT_THAT(drill, HasSubstr("(mark 1)\nG0 X-1119 Y-509\nG1 Z-3 F150\nG0 Z5\n(mark 2)\n"));
  EXPECT_EQ(run("gcode check marks.nc").code, 0);
  ASSERT_EQ(run("plan --machine " + machine_ + " --measure lengths -o l.csv --gcode l.nc").code, 0);
  EXPECT_THAT(content_of(folder_ / "l.nc"),
              AllOf(HasSubstr("G0 X-1119 Y-509\nM0 (mark 1: write down both chain lengths"),
                    Not(HasSubstr("G1 "))));
}

TEST_F(SheetOfPlan, ThePageHasALineForEveryReading) {
  ASSERT_EQ(run("plan --machine " + machine_ + " -o marks.csv --page marks.html").code, 0);
  const std::string page = content_of(folder_ / "marks.html");
  EXPECT_THAT(page,
              AllOf(StartsWith("<!DOCTYPE html>"),
                    HasSubstr("<td>28</td><td>"),
                    HasSubstr("break-inside: avoid"),
                    HasSubstr("Type the readings into marks.csv")));
  ASSERT_EQ(run("plan --machine " + machine_ + " --holes 9 -o h.csv --page h.html").code, 0);
  EXPECT_THAT(content_of(folder_ / "h.html"), HasSubstr("the tape says, mm"));
}

TEST_F(SheetOfPlan, IsOverwrittenOnlyWhileNobodyWroteIntoIt) {
  for (const std::string name : {"marks.csv", "marks.json"}) {
    ASSERT_EQ(run("plan --machine " + machine_ + " -o " + name).code, 0);
    EXPECT_EQ(run("plan --machine " + machine_ + " -o " + name).code, 0);
  }
  write("marks.csv", filled("marks.csv", 0));
  EXPECT_EQ(run("plan --machine " + machine_ + " -o marks.csv").code, 3);
}

TEST_F(SheetOfPlan, HasAsManySecondVisitsAsAreAskedForTheFirstMarksLast) {
  ASSERT_EQ(run("plan --machine " + machine_ + " --second-visits 4 -o marks.csv").code, 0);
  EXPECT_THAT(content_of(folder_ / "marks.csv"), HasSubstr("\n32,-1119,-509,,\n"));
  // 28 marks bear nine; the 25 of a bed of 300 mm eight.
  std::string small = content_of(classic_);
  for (const std::string key : {"width_mm", "height_mm"}) {
    const std::size_t at = small.find(':', small.find(key)) + 1;
    small.replace(at, small.find_first_of(",}", at) - at, " 300");
  }
  write("small.json", small);
  EXPECT_EQ(run("plan --machine small.json --second-visits 8 -o small.csv").code, 0);
  const Outcome refused = run("plan --machine small.json --second-visits 9 -o more.csv");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("--second-visits: found 9, expected a number from 0 to 8"));
}

}  // namespace
}  // namespace chaintrue
