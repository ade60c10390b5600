// SPDX-License-Identifier: GPL-3.0-or-later
// Every verb ends with the next command, and that command works as printed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing_support::Outcome;

/// The command of the last line that begins with "Next:", without the program's name.
std::string next_of(const std::string& talk) {
  const std::string begin = "Next: chaintrue ";
  const std::size_t at = talk.rfind(begin);
  if (at == std::string::npos) return {};
  const std::size_t from = at + begin.size();
  return talk.substr(from, talk.find('\n', from) - from);
}

class NextStep : public testing_support::CommandFixture {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    const std::string fixtures = CHAINTRUE_FIXTURES;
    ASSERT_EQ(run("fit " + fixtures + "/grids/seven_by_four.json -o map.json").code, 0);
    const Outcome copied =
        run_line("cp " + fixtures + "/machines/classic.json machine.json && cp " + fixtures +
                 "/gcode/bracket.nc part.nc && cp " + fixtures +
                 "/grids/five_new_points.json five.json && cp " + fixtures +
                 "/holes/nine_holes.json holes.json");
    ASSERT_EQ(copied.code, 0) << copied.err;
    write("few.csv", "x_mm,y_mm\n0,0\n");
    std::string many = "x_mm,y_mm\n";
    for (const char* x : {"-900", "-300", "300", "900"})
      for (const char* y : {"-400", "0", "400"}) many += std::string(x) + "," + y + "\n";
    write("many.csv", many);
  }
};

TEST_F(NextStep, OfEveryVerbWorks) {
  ASSERT_EQ(run("gcode compensate part.nc --map map.json -o part.true.nc").code, 0);
  const std::vector<std::string> lines = {
      "simulate --machine machine.json --grid 7x4 --effect ring_radius:-:offset_mm=2 -o bare.json",
      "simulate --machine machine.json --grid 7x4 --length-noise-mm 0.2 --position-noise-mm 0.3 "
      "--effect ring_radius:-:offset_mm=2 --seed 1 -o simulated.json",
      "simulate --machine machine.json --holes 9 --seed 1 -o simulated.holes.json",
      "simulate --machine machine.json --points few.csv -o few.json",
      "simulate --machine machine.json --points many.csv -o many.json",
      "sweep " CHAINTRUE_FIXTURES "/sweeps/quick.json -o sweep",
      "query map.json 100 200",
      "check map.json five.json",
      "passes holes.json",
      "passes holes.json -o passes.json",
      "report map.json -o report.html",
      "gcode check part.nc",
      "gcode check part.nc --map map.json",
      "gcode lengths part.nc --map map.json -o lengths.csv",
      "gcode verify part.nc part.true.nc --map map.json",
      "gcode verify part.nc part.nc --map map.json",
      "gcode explain part.nc:3 --map map.json",
      "diagnose simulated.json -o d.json",
      "diagnose simulated.json -o d.json --report d.html",
      "diagnose simulated.json",
      "plan simulated.json --after d.json -o more.txt",
      "export groundcontrol machine.json",
      "export groundcontrol map.json",
      "export groundcontrol d.json",
      "effects",
      "effects chain_stretch",
      "square --map map.json --size-mm 500",
      "square --map map.json --size-mm 500 --gcode square.nc",
  };
  for (const std::string& line : lines) {
    const Outcome outcome = run(line);
    const std::string next = next_of(outcome.err);
    ASSERT_NE(next, "") << line << "\n" << outcome.err;
    const Outcome after = run(next);
    EXPECT_EQ(after.code, 0) << line << "\n" << next << "\n" << after.err;
  }
}

TEST_F(NextStep, CallsTheCommandAsItWasCalled) {
  const std::string query = " query map.json 100 200";
  const Outcome by_path = run_line(CHAINTRUE_COMMAND + query);
  EXPECT_THAT(by_path.err, HasSubstr("Next: " CHAINTRUE_COMMAND " report"));
  const Outcome relative = run_line("ln -s " CHAINTRUE_COMMAND " . && ./chaintrue" + query);
  EXPECT_THAT(relative.err, HasSubstr("Next: ./chaintrue report"));
  EXPECT_THAT(run(query).err, HasSubstr("Next: chaintrue report"));
}

TEST_F(NextStep, IsNotSaidInAPipe) {
  EXPECT_EQ(next_of(run_line(CHAINTRUE_COMMAND " query - 100 200 <map.json").err), "");
}

TEST_F(NextStep, PassesTellScriptsWhatTheyTellPeople) {
  const Outcome outcome = run("passes holes.json --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\"number\": 1, "));
  EXPECT_THAT(outcome.out, HasSubstr("\"true_mm\": null"));
  const Outcome simulated = run("passes --machine machine.json --passes 1 --seed 1 --json");
  EXPECT_EQ(simulated.code, 0) << simulated.err;
  EXPECT_THAT(simulated.out, testing::ContainsRegex("\"before_mm\": [0-9.]+,"));
  EXPECT_THAT(simulated.out, testing::ContainsRegex("\"true_mm\": [0-9.]+}"));
}

TEST_F(NextStep, ATestSquareIsCutAndItsCompensationIsSquare) {
  const Outcome square = run("square --map map.json --size-mm 500 --gcode square.nc --json");
  ASSERT_EQ(square.code, 0) << square.err;
  EXPECT_THAT(square.err, HasSubstr("measure the four sides and both diagonals"));
  EXPECT_EQ(next_of(square.err), "gcode compensate square.nc --map map.json -o square.true.nc");
  EXPECT_THAT(testing_support::content_of(folder_ / "square.nc"),
              HasSubstr("G1 X-250.000 Y250.000 F600\nG1 X250.000 Y250.000 F600\nG1 X250.000 "
                        "Y-250.000 F600\nG1 X-250.000 Y-250.000 F600\n"));
  // The tool's position by the map, from the lengths along the same program.
  ASSERT_EQ(run(next_of(square.err)).code, 0);
  const Outcome verified = run("gcode verify square.nc square.true.nc --map map.json");
  EXPECT_EQ(verified.code, 0) << verified.out;
}

TEST_F(NextStep, ASquareThatTheMapDoesNotReachIsRefused) {
  const Outcome square = run("square --map map.json --size-mm 500 --at 3000 0 --gcode square.nc");
  EXPECT_EQ(square.code, 4) << square.err;
  EXPECT_FALSE(exists("square.nc"));
  EXPECT_EQ(run("square --size-mm 500").code, 2);
}

}  // namespace
}  // namespace chaintrue
