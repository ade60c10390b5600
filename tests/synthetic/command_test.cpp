// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// `chaintrue simulate` and `chaintrue effects` through the command: exit codes, messages, and that
/// bad input writes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "grid/files/grid_file.hpp"
#include "grid/files/whole_file.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kCommand = CHAINTRUE_COMMAND;
const std::string kClassic = std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json";

struct Outcome {
  int code = -1;
  std::string said;
};

// Runs a line with the command in place of "chaintrue"; both streams combined.
Outcome say(const std::string& line) {
  Outcome outcome;
  std::FILE* pipe = popen((kCommand + " " + line + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.said.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

class Command : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kCommand.empty()) GTEST_SKIP() << "the command is not built";
    out_ = std::filesystem::path(::testing::TempDir()) /
           ("chaintrue_simulate_" + std::to_string(getpid()) + ".json");
    std::filesystem::remove(out_);
  }
  void TearDown() override { std::filesystem::remove(out_); }
  [[nodiscard]] std::string simulate(const std::string& options) const {
    return "simulate --machine " + kClassic + " " + options + " -o " + out_.string();
  }
  std::filesystem::path out_;
};

TEST_F(Command, SimulateWritesAGridThatReadsBack) {
  const Outcome outcome = say(
      simulate("--grid 7x4 --jitter-mm 8 --length-noise-mm 0.2 --position-noise-mm 0.3 --repeats 6 "
               "--effect chain_pitch_error:left:elongation=0.0012 --seed 3"));
  EXPECT_EQ(outcome.code, 0) << outcome.said;
  const grid::MeasuredGrid grid = grid::files::read_grid(out_).grid;
  EXPECT_EQ(grid.points.size(), 34U);
  EXPECT_TRUE(grid.machine->effects.empty());
  EXPECT_EQ(grid.noise->length_mm, 0.2);
}

TEST_F(Command, SimulateReportsAllSlipsAndWritesNothing) {
  const Outcome outcome =
      say(simulate("--grid 7q4 --effect drift:x:rate_mm_per_visit=0.1 --effect rust "
                   "--offset motor=1 --order zigzag"));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(
      outcome.said,
      AllOf(
          HasSubstr("--grid: found 7q4, expected columns x rows"),
          HasSubstr(
              "found x in drift:x:rate_mm_per_visit=0.1, expected \"left\", \"right\" or \"both\""),
          HasSubstr("found rust, expected id:side:key=value"),
          HasSubstr("--offset: found motor=1"),
          HasSubstr("--order: found zigzag, expected rows")));
  const Outcome numbers = say(simulate("--grid 7x4 --jitter-mm -3 --length-noise-mm x"));
  EXPECT_EQ(numbers.code, 3);
  EXPECT_THAT(numbers.said,
              AllOf(HasSubstr("--jitter-mm: found -3"), HasSubstr("--length-noise-mm: found x")));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Command, SimulateNeedsToKnowWhere) { EXPECT_EQ(say(simulate("")).code, 2); }

TEST_F(Command, SimulateRefusesOffsetsThatLeaveNoMachine) {
  const Outcome outcome = say(simulate("--grid 7x4 --offset motor_left_y_mm=-600"));
  EXPECT_EQ(outcome.code, 3) << outcome.said;
  EXPECT_THAT(outcome.said, HasSubstr("--offset: found /motors/left/y_mm = 472."));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Command, SimulateAtGivenPlacesLeavesOutWhatIsOutOfReach) {
  const std::string line = simulate("--points -");
  std::FILE* pipe = popen(
      ("printf 'x_mm,y_mm\\n0,0\\n0,3000\\n' | " + kCommand + " " + line + " 2>/dev/null").c_str(),
      "r");
  ASSERT_NE(pipe, nullptr);
  const int status = pclose(pipe);
  EXPECT_EQ(WEXITSTATUS(status), 4);
  const std::string text = grid::files::read_whole_file(out_);
  // table_over_top.json states 1701.69669 at compliance 5.1685e-6; the fixture has 5.17e-6.
  EXPECT_THAT(text, HasSubstr("\"left_mm\": 1701.696"));
}

TEST_F(Command, EffectsListsEveryEffect) {
  const Outcome outcome = say("effects");
  EXPECT_EQ(outcome.code, 0);
  for (const model::effects::Effect* effect : model::effects::catalogue()) {
    EXPECT_THAT(outcome.said, HasSubstr(std::string(effect->id)));
  }
}

TEST_F(Command, EffectsDrawsOneAndSaysHowLargeItMustBe) {
  const Outcome outcome =
      say("effects sprocket_radius --machine " + kClassic + " --draw " + out_.string());
  EXPECT_EQ(outcome.code, 0) << outcome.said;
  EXPECT_THAT(outcome.said,
              AllOf(HasSubstr("A square of 100 mm"), HasSubstr("never"), HasSubstr("  28 ")));
  EXPECT_THAT(grid::files::read_whole_file(out_), HasSubstr("<svg"));
}

TEST_F(Command, EffectsKnowsEveryEffectOnTheClassicMachine) {
  for (const model::effects::Effect* effect : model::effects::catalogue()) {
    const Outcome outcome =
        say("effects " + std::string(effect->id) + " --json --machine " + kClassic);
    EXPECT_EQ(outcome.code, 0) << outcome.said;
    EXPECT_THAT(outcome.said, HasSubstr("\"strength\""));
  }
}

TEST_F(Command, EffectsRefusesWhatIsNotCatalogued) {
  EXPECT_EQ(say("effects rust").code, 3);
  EXPECT_EQ(say("effects drift --machine " + kClassic + " --side x").code, 3);
  EXPECT_EQ(say("effects drift --machine " + kClassic + " --set rate_mm_per_visit=7").code, 3);
}

TEST_F(Command, EffectsDrawsAnAtlasOfEachKindOfMachine) {
  const std::string fixtures = CHAINTRUE_FIXTURES;
  const std::string page = out_.string() + ".html";
  std::string before;
  for (const char* machine : {"/machines/classic.json",
                              "/good/anchors_every_key.json",
                              "/good/plotter_every_key.json",
                              "/good/drawing_every_key.json",
                              "/plotter/mural.txt"}) {
    SCOPED_TRACE(machine);
    const std::string line = "effects --atlas " + fixtures + machine + " -o " + page;
    const Outcome outcome = say(line);
    EXPECT_EQ(outcome.code, 0) << outcome.said;
    EXPECT_THAT(outcome.said, HasSubstr("pictures of what may be wrong"));
    const std::string text = grid::files::read_whole_file(page);
    EXPECT_THAT(text, AllOf(HasSubstr("<svg"), HasSubstr("type=\"range\"")));
    EXPECT_NE(text, before);
    EXPECT_EQ(say(line).code, 0);
    EXPECT_EQ(grid::files::read_whole_file(page), text);
    before = text;
  }
  std::filesystem::remove(page);
}

TEST_F(Command, AnAtlasIsRefusedOfWhatIsNoMachineAndOfEffectsOfTwoChainsOnBelts) {
  const std::string fixtures = CHAINTRUE_FIXTURES;
  const std::string output = " -o " + out_.string();
  const Outcome grid = say("effects --atlas " + fixtures + "/good/grid_every_key.json" + output);
  EXPECT_EQ(grid.code, 3);
  EXPECT_THAT(grid.said, HasSubstr("\"chaintrue_machine\""));
  const Outcome belts = say("effects --atlas " + fixtures + "/good/anchors_every_key.json" + output +
                            " --effects " + kClassic);
  EXPECT_EQ(belts.code, 3);
  EXPECT_THAT(belts.said, HasSubstr("declared effects are of two chains"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace chaintrue
