// SPDX-License-Identifier: GPL-3.0-or-later
// Conventions of the command line: suggestions for typing errors, two ways to get help, --quiet,
// JSON, colours only on terminals, lines that are not broken, and files of the wrong kind
// identified by their kind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing_support::content_of;
using testing_support::Outcome;

class Conversation : public testing_support::CommandFixture {
 protected:
  const std::string grid_ = std::string(CHAINTRUE_FIXTURES) + "/grids/seven_by_four.json";
  const std::string classic_ = std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json";
};

TEST_F(Conversation, KnowsWhichVerbWasMeant) {
  const Outcome verb = run("digagnose grid.json");
  EXPECT_EQ(verb.code, 2);
  EXPECT_THAT(verb.err,
              HasSubstr("There is no chaintrue digagnose. Did you mean chaintrue diagnose?\n"));
  const Outcome below = run("gcode compensat part.nc");
  EXPECT_EQ(below.code, 2);
  EXPECT_THAT(below.err, HasSubstr("Did you mean chaintrue gcode compensate?"));
  EXPECT_EQ(run("xyzzy").err,
            "There is no chaintrue xyzzy. chaintrue --help lists what there is.\n");
  const Outcome help = run("help fot");
  EXPECT_EQ(help.code, 2);
  EXPECT_EQ(help.err, "There is no chaintrue fot. Did you mean chaintrue fit?\n");
  EXPECT_EQ(help.out, "");
}

TEST_F(Conversation, KnowsWhichOptionWasMeant) {
  const Outcome option = run("fit " + grid_ + " --machin m.json -o map.json");
  EXPECT_EQ(option.code, 2);
  EXPECT_THAT(option.err,
              HasSubstr("chaintrue fit has no option --machin. Did you mean --machine?\n"));
  EXPECT_FALSE(exists("map.json"));
  // Other missing options follow from the typing error and are not reported first.
  EXPECT_EQ(run("fit --machin m.json").err,
            "chaintrue fit has no option --machin. Did you mean --machine?\n");
}

TEST_F(Conversation, HelpsByBothWays) {
  const Outcome help = run("help fit");
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.out, run("fit --help").out);
  EXPECT_EQ(run("help gcode verify").out, run("gcode verify --help").out);
  EXPECT_EQ(run("help").out, run("--help").out);
  EXPECT_EQ(run("-V").out, run("--version").out);
}

TEST_F(Conversation, IsQuietWhereItIsAskedToBe) {
  for (const std::string& line : {"fit " + grid_ + " -o map.json --quiet",
                                  "--quiet fit " + grid_ + " -o map.json",
                                  "fit -q " + grid_ + " -o map.json"}) {
    const Outcome fit = run(line);
    EXPECT_EQ(fit.code, 0) << line;
    EXPECT_EQ(fit.err, "") << line;
  }
  const Outcome fails = run("fit nothing.json -o map2.json --quiet");
  EXPECT_EQ(fails.code, 3);
  EXPECT_THAT(fails.err, HasSubstr("nothing.json"));
  const Outcome no_machine =
      run("fit " + std::string(CHAINTRUE_FIXTURES) + "/grids/seed_001.csv -o map2.json --quiet");
  EXPECT_EQ(no_machine.code, 3);
  EXPECT_NE(no_machine.err, "");
}

TEST_F(Conversation, TellsAFitInAFewLinesAndTheRestWhenAsked) {
  const Outcome brief = run("fit " + grid_ + " -o map.json");
  EXPECT_THAT(brief.err,
              AllOf(StartsWith("Your machine misses by about "),
                    HasSubstr("It is least sure near (1118, 508)"),
                    Not(HasSubstr("rms")),
                    Not(HasSubstr("left motor, x")),
                    Not(HasSubstr("mirrored")),
                    EndsWith("Next: chaintrue report map.json -o map.html\n")));
  const Outcome whole = run("fit " + grid_ + " -o map.json --verbose");
  EXPECT_THAT(whole.err,
              AllOf(HasSubstr("left motor, x"),
                    HasSubstr("a block of the bed at a time"),
                    HasSubstr("is not the left one mirrored")));
  EXPECT_EQ(run("report map.json -o map.html").code, 0);
}

TEST_F(Conversation, TellsAFitAsJson) {
  const Outcome fit = run("fit " + grid_ + " -o map.json --json --quiet");
  EXPECT_EQ(fit.code, 0);
  EXPECT_THAT(fit.out,
              AllOf(HasSubstr("\"file_type\": \"chaintrue_fit\""),
                    HasSubstr("\"points\": 34"),
                    HasSubstr("\"setting\": \"motor_left_x_mm\"")));
  EXPECT_EQ(run("fit " + grid_ + " -o - --json").code, 2);
}

TEST_F(Conversation, KeepsTalkAndDataOnLinesOfTheirOwn) {
  const Outcome both =
      run_line(CHAINTRUE_COMMAND " diagnose " + grid_ + " --report page.html 2>&1");
  EXPECT_EQ(both.code, 0);
  EXPECT_THAT(both.out, HasSubstr("\nThe report is page.html"));
}

TEST_F(Conversation, HasNoColoursInAPipe) {
  const Outcome fit = run("fit nothing.json -o map.json");
  EXPECT_THAT(fit.err, Not(HasSubstr("\x1b[")));
}

TEST_F(Conversation, NamesAFileOfTheWrongKind) {
  ASSERT_EQ(run("fit " + grid_ + " -o map.json").code, 0);
  const Outcome diagnose = run("diagnose map.json");
  EXPECT_EQ(diagnose.code, 3);
  EXPECT_THAT(diagnose.err,
              HasSubstr("\"chaintrue_drawing\"; this is a map; did you mean chaintrue report, "
                        "query, gcode or export?"));
  write("marks.xlsx", std::string("PK\x03\x04", 4) + "zip");
  write("marks.pdf", "%PDF-1.7");
  EXPECT_THAT(run("fit marks.xlsx --machine " + classic_ + " -o m.json").err,
              HasSubstr("found a spreadsheet of Excel or LibreOffice"));
  EXPECT_THAT(run("fit marks.pdf --machine " + classic_ + " -o m.json").err,
              HasSubstr("found a PDF"));
}

TEST_F(Conversation, GivesAnEmptyMachineTheWayToATemplate) {
  write("machine.json", "{}");
  const Outcome plan = run("plan --machine machine.json");
  EXPECT_EQ(plan.code, 3);
  EXPECT_EQ(plan.err,
            "machine.json: found an empty machine, expected a machine; chaintrue start writes one "
            "to fill in, with every key explained\n");
}

}  // namespace
}  // namespace chaintrue
