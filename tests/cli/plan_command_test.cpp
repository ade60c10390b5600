// SPDX-License-Identifier: GPL-3.0-or-later
// The list of chaintrue plan, its drawing, and its exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

using testing_support::content_of;
using testing_support::Outcome;

class PlanCommand : public testing_support::CommandFixture {
 protected:
  const std::string machine_ = std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json";
};

TEST_F(PlanCommand, ListsThePointsAndTellsTheErrorApart) {
  const Outcome outcome = run("plan --machine " + machine_ + " --points 28");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("order,x_mm,y_mm,left_mm,right_mm\n1,-1119,-509,,\n2,"));
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 29);
  EXPECT_THAT(outcome.err, HasSubstr("28 points: "));
  EXPECT_THAT(outcome.err, HasSubstr("mm rms over the bed"));
}

TEST_F(PlanCommand, WritesTheSameListAndDrawingTwice) {
  ASSERT_EQ(run("plan --machine " + machine_ + " --points 13 -o a.csv --svg a.svg").code, 0);
  ASSERT_EQ(run("plan --machine " + machine_ + " --points 13 -o b.csv --svg b.svg").code, 0);
  EXPECT_EQ(content_of(folder_ / "a.csv"), content_of(folder_ / "b.csv"));
  EXPECT_EQ(content_of(folder_ / "a.svg"), content_of(folder_ / "b.svg"));
  const std::string drawing = content_of(folder_ / "a.svg");
  EXPECT_THAT(drawing, StartsWith("<svg "));
  EXPECT_THAT(drawing, HasSubstr(">13</text>"));
  EXPECT_THAT(drawing, testing::EndsWith("</svg>\n"));
}

TEST_F(PlanCommand, ItsListIsMeasuredBySimulate) {
  ASSERT_EQ(run("plan --machine " + machine_ + " --points 12 -o plan.csv").code, 0);
  const Outcome outcome = run("simulate --machine " + machine_ + " --marks plan.csv -o grid.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(exists("grid.json"));
}

TEST_F(PlanCommand, ValuesOutOfRangeExitWithThreeAllAtOnceAndWriteNothing) {
  // Outside the option's range, and outside the range for this bed.
  for (const char* values :
       {" --points 0 --margin-mm -1 --length-noise-mm 0", " --points 5 --margin-mm 900"}) {
    const Outcome outcome = run("plan --machine " + machine_ + values + " -o p.csv");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("--points"));
    EXPECT_THAT(outcome.err, HasSubstr("--margin-mm"));
    EXPECT_EQ(outcome.err.find("--length-noise-mm") != std::string::npos,
              std::string(values).ends_with(" 0"));
    EXPECT_FALSE(exists("p.csv"));
  }
}

TEST_F(PlanCommand, AMissingMachineAndABadNumberExitWithThreeMissingOptionsWithTwo) {
  EXPECT_EQ(run("plan --machine nowhere.json").code, 3);
  EXPECT_EQ(run("plan").code, 2);
  EXPECT_EQ(run("plan --machine " + machine_ + " --points many").code, 3);
}

}  // namespace
}  // namespace chaintrue
