// SPDX-License-Identifier: GPL-3.0-or-later
// Exit codes, streams and files of fit and query, as scripts rely on them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

using testing_support::content_of;
using testing_support::Outcome;

class Command : public testing_support::CommandFixture {
 protected:
  const std::string grid_ = std::string(CHAINTRUE_FIXTURES) + "/grids/seven_by_four.json";
};

TEST_F(Command, FitWritesTheSameMapTwice) {
  ASSERT_EQ(run("fit " + grid_ + " -o a.json").code, 0);
  ASSERT_EQ(run("fit " + grid_ + " -o b.json").code, 0);
  EXPECT_EQ(content_of(folder_ / "a.json"), content_of(folder_ / "b.json"));
}

TEST_F(Command, FitTalksOnStandardErrorAlone) {
  const Outcome outcome = run("fit " + grid_ + " -o map.json");
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("With this map it misses by about"));
}

TEST_F(Command, QueryAnswersPointsFromArgumentsFileAndStandardInputAlike) {
  ASSERT_EQ(run("fit " + grid_ + " -o map.json").code, 0);
  write("points.csv", "x_mm,y_mm\n100,200\n-1000,-450\n");
  const Outcome arguments = run("query map.json 100 200 -1000 -450");
  EXPECT_EQ(arguments.code, 0);
  EXPECT_THAT(
      arguments.out,
      StartsWith("x_mm,y_mm,left_mm,right_mm,left_sigma_mm,right_sigma_mm,status\n100,200,"));
  EXPECT_EQ(run("query map.json --points points.csv").out, arguments.out);
  EXPECT_EQ(run("query map.json --points - < points.csv").out, arguments.out);
  ASSERT_EQ(run("query map.json --points points.csv -o answers.csv").code, 0);
  EXPECT_EQ(content_of(folder_ / "answers.csv"), arguments.out);
}

TEST_F(Command, QueryGivesThePointForLengths) {
  ASSERT_EQ(run("fit " + grid_ + " -o map.json").code, 0);
  const std::string answer = run("query map.json 100 200").out;
  const std::string row = answer.substr(answer.find('\n') + 1);
  const std::size_t left = row.find(',', row.find(',') + 1) + 1;
  const std::size_t right = row.find(',', left) + 1;
  const std::string lengths =
      row.substr(left, right - left - 1) + " " + row.substr(right, row.find(',', right) - right);
  // Lengths are printed to 1e-6 mm.
  EXPECT_THAT(run("query map.json --inverse " + lengths).out,
              testing::MatchesRegex(
                  "x_mm,y_mm,status\n(100.00000.|99.99999.),(200.00000.|199.99999.),inside\n"));
}

// Where a query has an answer its lengths are inverted to the point; elsewhere the point is not
// inside.
TEST_F(Command, OfADirectMapQueryAndInverseAgree) {
  ASSERT_EQ(run("simulate --machine " CHAINTRUE_FIXTURES
                "/machines/classic.json --grid 7x4 --margin-mm 200 -o lattice.json")
                .code,
            0);
  ASSERT_EQ(run("fit lattice.json --surface direct -o direct.json").code, 0);
  for (const char* place : {"0 0", "1015 0", "1050 0", "1100 500", "-1215 -605"}) {
    SCOPED_TRACE(place);
    const Outcome query = run(std::string("query direct.json ") + place);
    if (query.code != 0) {
      EXPECT_EQ(query.code, 4);
      EXPECT_THAT(query.out, HasSubstr(",,,,,outside"));
      continue;
    }
    std::istringstream row(query.out.substr(query.out.find('\n') + 1));
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 7U);
    const Outcome back = run("query direct.json --inverse " + cells[2] + " " + cells[3]);
    EXPECT_EQ(back.code, 0) << back.err;
    EXPECT_THAT(back.out, HasSubstr(cells[6].substr(0, cells[6].find('\n'))));
  }
}

TEST_F(Command, QueryWritesWhatIsInsideAndExitsWithFourForTheRest) {
  ASSERT_EQ(run("fit " + grid_ + " -o map.json").code, 0);
  const Outcome outcome = run("query map.json 5000 0 100 200");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.out, HasSubstr("5000,0,,,,,outside\n100,200,"));
  EXPECT_THAT(outcome.err, HasSubstr("(5000, 0): the point is off the bed"));
}

TEST_F(Command, UnusableArgumentsExitWithTwo) {
  for (const char* arguments :
       {"", "fitt", "fit", "query", "query map.json", "query map.json 1", "fit grid.json"}) {
    EXPECT_EQ(run(arguments).code, 2) << arguments;
  }
}

TEST_F(Command, BadInputExitsWithThreeAndWritesNothing) {
  write("grid.json",
        "{\"file_type\": \"chaintrue_grid\", \"format_version\": \"1.0\", \"points\": [], "
        "\"colour\": 1}");
  const Outcome outcome = run("fit grid.json -o map.json");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("grid.json: /points"));
  EXPECT_THAT(outcome.err, HasSubstr("grid.json: /colour"));
  EXPECT_FALSE(exists("map.json"));
  EXPECT_EQ(run("query missing.json 0 0").code, 3);
  EXPECT_EQ(run("query " + grid_ + " 0 0").code, 3);
}

TEST_F(Command, AFitThatCannotBeMadeSaysWhyAndWritesNothing) {
  const Outcome outcome = run("fit " + grid_ + " --surface direct -o map.json");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("full rows and columns"));
  EXPECT_FALSE(exists("map.json"));
}

TEST_F(Command, AMapThatWasDamagedIsRefusedByPlace) {
  ASSERT_EQ(run("fit " + grid_ + " -o map.json").code, 0);
  std::string text = content_of(folder_ / "map.json");
  text.replace(text.find("\"x_intervals\": "), 16, "\"x_intervals\": 1");
  write("damaged.json", text);
  const Outcome outcome = run("query damaged.json 0 0");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("/on_machine/residual/coefficients_left_mm"));
}

}  // namespace
}  // namespace chaintrue
