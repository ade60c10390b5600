// SPDX-License-Identifier: GPL-3.0-or-later
// Gross slips on the road from measured files to a cut: refused with exit 3 and no map, or asked
// about and set aside; and a map that is not to be cut with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::Outcome;

class Slips : public testing_support::CommandFixture {
 protected:
  void expect_no_map(const std::string& file, const std::string& words) const {
    const Outcome fitted = run("fit " CHAINTRUE_FIXTURES "/" + file + " -o map.json");
    EXPECT_EQ(fitted.code, 3) << file;
    EXPECT_THAT(fitted.err, HasSubstr(words)) << file;
    EXPECT_FALSE(exists("map.json")) << file;
    const Outcome diagnosed = run("diagnose " CHAINTRUE_FIXTURES "/" + file);
    EXPECT_EQ(diagnosed.code, 3) << file;
    EXPECT_THAT(diagnosed.err, HasSubstr(words)) << file;
  }
};

TEST_F(Slips, OfAWholeFileMakeNoMap) {
  expect_no_map("bad/grid_x_mirrored.json", "the sign of x_mm looks turned round");
  expect_no_map("bad/grid_no_minus.json", "all the minus signs of x_mm look left out");
  expect_no_map("bad/grid_marks_in_centimetres.json", "x_mm and y_mm look like centimetres");
  expect_no_map("bad/grid_a_row_left_out.json", "fit the command of the line after");
  expect_no_map("bad/grid_mark_above_the_motors.json",
                "Mark 8 lies above the motors: are x and y swapped?");
}

TEST_F(Slips, OfARowAreAskedAboutAndSetAside) {
  const Outcome digits =
      run("fit " CHAINTRUE_FIXTURES "/good/grid_digits_exchanged.json -o map.json");
  EXPECT_EQ(digits.code, 0) << digits.err;
  EXPECT_THAT(digits.err,
              AllOf(HasSubstr("/points/9: Mark 10 lies 90 mm off where the others put it. x_mm "
                              "-436.3: is it -346.3 rather than -436.3?"),
                    HasSubstr("Point 10 at (-436, 399) is off by")));
}

TEST_F(Slips, AMapThatIsFarOffIsNotToBeCutWith) {
  const std::string machine = CHAINTRUE_FIXTURES "/machines/classic.json";
  ASSERT_EQ(run("simulate --machine " + machine +
                " --grid 7x4 --length-noise-mm 5 --position-noise-mm 6 --seed 3 -o wild.json")
                .code,
            0);
  const Outcome fitted = run("fit wild.json -o map.json");
  EXPECT_EQ(fitted.code, 1) << fitted.err;
  EXPECT_THAT(fitted.err, HasSubstr("Do not cut with this map"));
  ASSERT_TRUE(exists("map.json"));
  const Outcome exported = run("export groundcontrol map.json -o settings.ini");
  EXPECT_EQ(exported.code, 1);
  EXPECT_THAT(
      exported.err,
      AllOf(HasSubstr("Do not cut with this map"), HasSubstr("--force goes on all the same")));
  EXPECT_FALSE(exists("settings.ini"));
  EXPECT_EQ(run("export groundcontrol map.json -o settings.ini --force").code, 0);
  const std::string compensate =
      "gcode compensate " CHAINTRUE_FIXTURES "/gcode/bracket.nc --map map.json -o true.nc";
  EXPECT_EQ(run(compensate).code, 1);
  EXPECT_FALSE(exists("true.nc"));
  EXPECT_THAT(run(compensate + " --force").err,
              testing::Not(HasSubstr("Do not cut with this map")));
}

}  // namespace
}  // namespace chaintrue
