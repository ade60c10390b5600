// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode through the command: what is written, what is not, and the messages.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue::testing_support {
namespace {

using testing::HasSubstr;

class GcodeCommand : public CommandFixture {
 protected:
  void SetUp() override {
    if (std::string(CHAINTRUE_COMMAND).empty()) GTEST_SKIP() << "the command is not built";
    CommandFixture::SetUp();
    ASSERT_EQ(run("fit " CHAINTRUE_FIXTURES "/grids/seven_by_four.json -o map.json").code, 0);
  }
  static std::string part() { return CHAINTRUE_FIXTURES "/gcode/bracket.nc"; }
};

TEST_F(GcodeCommand, CompensateSaysThatItRanItsOutput) {
  for (const char* controller : {"maslow_classic", "holey", "fluidnc_wallplotter", "ideal"}) {
    const std::string options = std::string(" --map map.json --controller ") + controller;
    const Outcome outcome = run("gcode compensate " + part() + options + " -o out.nc");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("run on a simulated ") + controller));
    EXPECT_THAT(outcome.err, HasSubstr("tolerance 0.05 mm"));
    EXPECT_EQ(run("gcode verify " + part() + " out.nc" + options).code, 0);
    std::filesystem::remove(folder_ / "out.nc");
  }
}

// verify alone kept silent on it.
TEST_F(GcodeCommand, AProgramWithoutUnitsIsSaidToBeTakenAsMillimetres) {
  write("bare.nc", "G0 X0 Y0\nG1 X100 F500\nM2\n");
  for (const char* verb : {"check bare.nc",
                           "check bare.nc --map map.json",
                           "compensate bare.nc --map map.json -o out.nc",
                           "verify bare.nc out.nc --map map.json"}) {
    const Outcome outcome = run(std::string("gcode ") + verb);
    EXPECT_EQ(outcome.code, 0) << verb << outcome.err;
    EXPECT_THAT(outcome.err,
                HasSubstr("before it says G20 or G21; it is taken to be in millimetres"))
        << verb;
  }
  write("stated.nc", "G21\nG0 X0 Y0\nG1 X100 F500\nM2\n");
  ASSERT_EQ(run("gcode compensate stated.nc --map map.json -o stated.true.nc").code, 0);
  EXPECT_THAT(run("gcode verify stated.nc stated.true.nc --map map.json").err,
              testing::Not(HasSubstr("millimetres")));
}

TEST_F(GcodeCommand, VerifyNamesTheFirstFault) {
  ASSERT_EQ(run("gcode compensate " + part() + " --map map.json -o out.nc").code, 0);
  std::string text = content_of(folder_ / "out.nc");
  const std::size_t cut = text.find("\nG1 X");
  write("bad.nc", text.replace(cut, 4, "\nG0 "));
  const Outcome outcome = run("gcode verify " + part() + " bad.nc --map map.json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("does not hold"));
  EXPECT_THAT(outcome.out, HasSubstr("the first fault: line"));
  const Outcome json = run("gcode verify " + part() + " bad.nc --map map.json --json");
  EXPECT_EQ(json.code, 1);
  EXPECT_THAT(json.out, HasSubstr("\"holds\": false"));
  EXPECT_THAT(json.out, HasSubstr("moves at a rapid where"));
}

/// A map with a wave narrower than the sampling of compensate: the tool would deviate, the
/// verification detects it, and nothing is written.
TEST_F(GcodeCommand, OutputThatDoesNotHoldIsNotWritten) {
  std::string asked = "x_mm,y_mm\n";
  std::vector<std::string> places;
  for (const int row : {-30, -3, -2, -1, 0, 1, 2, 3, 30}) {
    for (int column = -1; column <= 27; ++column) {
      const double x = 8.0 * column, y = 8.0 * row;
      const double wave = 0.4 * std::exp(-std::pow((x - 112.0) / 10.0, 2) - std::pow(y / 10.0, 2));
      places.push_back(fmt::format("{},{}", x, y));
      asked += fmt::format("{},{}\n", x, y + wave);
    }
  }
  write("asked.csv", asked);
  // The map's lengths at the tool's actual position become the readings at the commanded position.
  ASSERT_EQ(run("query map.json --points asked.csv -o lengths.csv").code, 0);
  std::ifstream lengths(folder_ / "lengths.csv");
  std::string grid = "x_mm,y_mm,left_mm,right_mm\n";
  std::string line;
  std::getline(lengths, line);
  ASSERT_THAT(line, testing::StartsWith("x_mm,y_mm,left_mm,right_mm,"));
  for (const std::string& place : places) {
    ASSERT_TRUE(std::getline(lengths, line));
    std::size_t comma[4] = {};
    for (std::size_t k = 0; k < 4; ++k) comma[k] = line.find(',', k == 0 ? 0 : comma[k - 1] + 1);
    grid += place + line.substr(comma[1], comma[3] - comma[1]) + "\n";
  }
  write("narrow.csv", grid);
  ASSERT_EQ(run("fit narrow.csv --surface direct -o narrow.json").code, 0);
  write("part.nc", "G21 G90\nF900 G0 X0 Y0\nG1 X200\nM2\n");
  const std::string compensate =
      "gcode compensate part.nc --map narrow.json --machine " CHAINTRUE_FIXTURES
      "/machines/classic.json --controller ideal -o out.nc";
  const Outcome outcome = run(compensate + " --report r.html");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the compensated program does not hold 0.05 mm: line "));
  EXPECT_THAT(outcome.err, HasSubstr("the program is not written; try another --tolerance-mm"));
  EXPECT_FALSE(exists("out.nc"));
  EXPECT_THAT(content_of(folder_ / "r.html"),
              HasSubstr("Not safe to run, and not written: on a simulated ideal"));
  // Without the wave it passes.
  EXPECT_EQ(run("gcode compensate part.nc --map map.json -o out.nc").code, 0);
}

TEST_F(GcodeCommand, BadProgramsLeaveNothing) {
  write("bad.nc", "G21 G90\nF900 G1 X10\nM98 P7 L2.7\n");
  const Outcome outcome = run("gcode compensate bad.nc --map map.json -o out.nc --report r.html");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("bad.nc: line 3, column 8: L, a count or a kind, is a whole"));
  EXPECT_FALSE(exists("out.nc"));
  EXPECT_FALSE(exists("r.html"));
}

TEST_F(GcodeCommand, CheckSaysWhatTheControllerCannotFollow) {
  write("part.nc",
        "G21 G90\nF1500 G0 X0 Y0\nG64 P0.1\nG1 X0.1\nG1 X0.2\nG2 X20 Y0.5 R400\nG18 G2 X30 I5 "
        "K0\nM2\n");
  const Outcome classic = run("gcode check part.nc --controller maslow_classic");
  EXPECT_EQ(classic.code, 0) << classic.err;
  EXPECT_THAT(classic.err, HasSubstr("line 3: note: maslow_classic ignores G64"));
  EXPECT_THAT(classic.err,
              HasSubstr("line 4: note: maslow_classic takes at least 10 ms for a move"));
  EXPECT_THAT(classic.err,
              HasSubstr("line 6: note: maslow_classic cuts so short or so wide an arc"));
  EXPECT_THAT(classic.err, HasSubstr("line 7: note: maslow_classic knows arcs in X and Y only"));
  const Outcome fluidnc = run("gcode check part.nc --controller fluidnc_wallplotter");
  EXPECT_THAT(fluidnc.err,
              HasSubstr("line 3: note: fluidnc_wallplotter stops with an error at G64"));
  EXPECT_THAT(fluidnc.err, HasSubstr("line 4: note: fluidnc_wallplotter plans 16 moves ahead"));
  EXPECT_THAT(run("gcode check part.nc").err, testing::Not(HasSubstr("maslow_classic")));
}

TEST_F(GcodeCommand, TheReportSaysWhetherTheFileIsSafe) {
  ASSERT_EQ(run("gcode compensate " + part() + " --map map.json -o out.nc --report r.html").code,
            0);
  EXPECT_THAT(content_of(folder_ / "r.html"), HasSubstr("The file is safe to run: on a simulated"));
  ASSERT_EQ(
      run("gcode compensate " + part() + " --map map.json -o out.nc --report r.html --no-verify")
          .code,
      0);
  EXPECT_THAT(content_of(folder_ / "r.html"), HasSubstr("is not known"));
}

TEST_F(GcodeCommand, TheReportsTitleIsTheProgramsNameWhateverThatIs) {
  const std::string name = "a<script>\xFF.nc";  // no UTF-8, and a tag
  std::filesystem::copy_file(part(), folder_ / name);
  ASSERT_EQ(run("gcode compensate '" + name + "' --map map.json -o out.nc --report r.html").code,
            0);
  const std::string page = content_of(folder_ / "r.html");
  EXPECT_THAT(page, HasSubstr("<title>a&lt;script&gt;\xEF\xBF\xBD.nc, compensated</title>"));
  EXPECT_EQ(page.find('\xFF'), std::string::npos);
}

}  // namespace
}  // namespace chaintrue::testing_support
