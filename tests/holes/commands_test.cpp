// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that accept holes, through the command: output, exit codes, nothing written for bad
// input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <functional>
#include <sstream>

#include "grid/files/holes_file.hpp"
#include "grid/files/json_text.hpp"
#include "grid/files/map_file.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using testing_support::content_of;
using testing_support::Outcome;

class HolesCommands : public testing_support::CommandFixture {
 protected:
  const std::string fixtures_ = CHAINTRUE_FIXTURES;
  const std::string classic_ = fixtures_ + "/machines/classic.json";
  const std::string holes_ = fixtures_ + "/holes/nine_holes.json";
};

TEST_F(HolesCommands, FitGivesAMapThatQueryAndCheckTake) {
  const Outcome fit = run("fit " + holes_ + " -o map.json --verbose");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err,
              AllOf(HasSubstr("20 distances between 9 holes: each one, left out in turn"),
                    HasSubstr("Error of distances left out one at a time"),
                    HasSubstr("Chain scales: left -0.1")));
  const Outcome query = run("query map.json 0 0");
  EXPECT_EQ(query.code, 0);
  EXPECT_THAT(query.out, HasSubstr("inside"));
  const Outcome check = run("check map.json " + holes_);
  EXPECT_EQ(check.code, 0) << check.out;
  EXPECT_THAT(check.out, StartsWith("The map is still valid"));
}

TEST_F(HolesCommands, FitTakesSeveralSetsOfOneMachine) {
  const std::string simulate = "simulate --machine " + classic_ + " --holes 9 --draw-settings ";
  ASSERT_EQ(run(simulate + "--seed 3 -o first.json").code, 0);
  ASSERT_EQ(run(simulate + "--seed 4 -o second.json").code, 0);
  const Outcome fit = run("fit first.json --with second.json --hook-sigma-mm 0.5 -o map.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err,
              HasSubstr("20 distances between 9 holes of second.json"));
  const Outcome other = run("fit first.json --with other.json -o none.json");
  EXPECT_EQ(other.code, 3);
  EXPECT_FALSE(exists("none.json"));
}

TEST_F(HolesCommands, FitTakesPointsAndDistancesTogether) {
  const std::string grid = fixtures_ + "/grids/seven_by_four.json";
  for (const std::string& files : {grid + " --with " + holes_, holes_ + " --with " + grid}) {
    const Outcome fit = run("fit " + files + " -o map.json --verbose");
    ASSERT_EQ(fit.code, 0) << fit.err;
    EXPECT_THAT(fit.err,
                AllOf(HasSubstr("Fitted together"),
                      HasSubstr("20 distances between 9 holes"),
                      HasSubstr("Chain scales")));
    EXPECT_EQ(run("query map.json 0 0").code, 0);
    EXPECT_EQ(run("report map.json -o report.html").code, 0);
  }
  const Outcome direct =
      run("fit " + grid + " --with " + holes_ + " --surface direct -o none.json");
  EXPECT_EQ(direct.code, 3);
  EXPECT_THAT(direct.err, HasSubstr("a direct surface is of one grid alone"));
  EXPECT_FALSE(exists("none.json"));
}

TEST_F(HolesCommands, CheckExitsWithOneWhereTheMapNoLongerHolds) {
  ASSERT_EQ(run("fit " + fixtures_ + "/grids/seven_by_four.json -o map.json").code, 0);
  write("marks.csv", "x_mm,y_mm\n-1100,500\n1100,500\n0,0\n-1100,-500\n1100,-500\n");
  ASSERT_EQ(run("simulate --machine " + classic_ +
                " --marks marks.csv --draw-settings --length-noise-mm 0.2 --position-noise-mm 0.2 "
                "--offset chain_zero_left_mm=2.5 --seed 1 -o later.json")
                .code,
            0);
  const Outcome check = run("check map.json later.json");
  EXPECT_EQ(check.code, 1);
  EXPECT_THAT(check.out, StartsWith("The map is valid after re-zeroing"));
  const Outcome json = run("check map.json later.json --json");
  EXPECT_EQ(json.code, 1);
  EXPECT_THAT(json.out, HasSubstr("\"verdict\": \"valid_after_rezeroing\""));
}

TEST_F(HolesCommands, PlanSetsThePointsOfACheck) {
  ASSERT_EQ(run("fit " + fixtures_ + "/grids/seven_by_four.json -o map.json").code, 0);
  const Outcome plan = run("plan --check map.json -o five.csv --svg five.svg");
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.err,
              AllOf(HasSubstr("5 points for chaintrue check. If one chain's links grow by 0.05 %, "
                              "they probably show it: that is 2.8 times the scatter"),
                    Not(HasSubstr("sigma"))));
  EXPECT_THAT(content_of(folder_ / "five.csv"), StartsWith("order,x_mm,y_mm,left_mm,right_mm\n1,"));
  EXPECT_THAT(content_of(folder_ / "five.svg"), StartsWith("<svg "));
  ASSERT_EQ(run("simulate --machine " + classic_ +
                " --marks five.csv --draw-settings --length-noise-mm 0.3 --position-noise-mm 0 "
                "--effect chain_pitch_error:left:elongation=0.001 --seed 1 -o later.json")
                .code,
            0);
  const Outcome check = run("check map.json later.json");
  EXPECT_EQ(check.code, 1);
  EXPECT_THAT(check.out,
              AllOf(StartsWith("The map is to be measured again"),
                    HasSubstr("the links of the left chain have grown")));
  const Outcome bad = run("plan --check map.json --points 0 --length-noise-mm 0 -o none.csv");
  EXPECT_EQ(bad.code, 3);
  EXPECT_THAT(bad.err, AllOf(HasSubstr("--points"), HasSubstr("--length-noise-mm")));
  EXPECT_FALSE(exists("none.csv"));
}

TEST_F(HolesCommands, ThePlannedProgramDrillsEveryHole) {
  const Outcome plan =
      run("plan --machine " + classic_ +
          " --holes 9 --tape-sigma-mm 0.5 -o list.csv --gcode holes.nc --svg h.svg");
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.err,
              AllOf(HasSubstr("9 holes, 20 distances"),
                    HasSubstr("motor spacing"),
                    HasSubstr("It tells little of"),
                    HasSubstr("Not shown")));
  const Outcome check = run("gcode check holes.nc");
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("9 straight cuts"));
  EXPECT_THAT(content_of(folder_ / "h.svg"), StartsWith("<svg "));
  // The list is a valid holes file, without readings.
  const Outcome fit = run("fit list.csv --machine " + classic_ + " -o map.json");
  EXPECT_EQ(fit.code, 3);
  EXPECT_THAT(fit.err, HasSubstr("found 20 distances, all left blank"));
}

TEST_F(HolesCommands, APlannedListFilledInGoesIntoFitAsItIs) {
  const Outcome plan =
      run("plan --machine " + classic_ +
          " --holes 9 --edges --tape-sigma-mm 0.5 -o list.csv --gcode holes.nc --svg h.svg");
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.err,
              AllOf(HasSubstr(" to the sheet's edges. With"),
                    HasSubstr("the whole job, sideways"),
                    HasSubstr("the whole job, turned"),
                    HasSubstr("mm per metre")));
  EXPECT_THAT(content_of(folder_ / "h.svg"), HasSubstr("green, square to an edge of the sheet"));
  EXPECT_THAT(run("gcode check holes.nc").out, HasSubstr("9 straight cuts"));
  // The owner cuts the holes of the list on a sheet that lies 6 mm to the right, and writes the
  // tape's readings into the third column.
  const std::string list = content_of(folder_ / "list.csv");
  grid::files::HolesOptions with_machine;
  with_machine.machine = grid::files::read_machine(classic_);
  const auto with_readings = [&list](const std::function<std::string(const std::string&)>& read) {
    std::istringstream lines(list);
    std::string filled;
    bool in_distances = false;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t blank = line.find(",,");
      if (in_distances && blank != std::string::npos)
        line.insert(blank + 1, read(line.substr(blank + 2)));
      in_distances = in_distances || line.starts_with("from,");
      filled += line + "\n";
    }
    return filled;
  };
  const grid::files::ReadHoles planned = grid::files::parse_holes(
      with_readings([](const std::string& as_commanded) { return as_commanded; }),
      "list.csv",
      with_machine);
  grid::synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.sheet.x_mm = 6.0;
  spec.rounding_mm = 0.5;
  spec.seed = 4;
  const auto made = grid::synthetic::simulate_holes(planned.holes, spec);
  ASSERT_TRUE(made);
  std::size_t reading = 0;
  write("readings.csv", with_readings([&](const std::string&) {
          return fmt::format("{:.1f}", made->set.distances.at(reading++).distance_mm);
        }));
  ASSERT_EQ(reading, made->set.distances.size());
  const Outcome fit = run("fit readings.csv --machine " + classic_ + " -o map.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr("With this map it misses by about"));
  EXPECT_EQ(run("check map.json readings.csv --machine " + classic_).code, 0);
  const grid::CompensationMap map = grid::files::read_map(folder_ / "map.json");
  // Half a millimetre of tape and of the sheet's size; three times that would be a gross error.
  EXPECT_LT(testing_support::tool_rms_mm(map, made->truth, spec.sheet), 1.5);
}

TEST_F(HolesCommands, SimulateMeasuresToTheEdgesOfASheetThatLiesAskew) {
  ASSERT_EQ(run("simulate --machine " + classic_ +
                " --holes 9 --edges --offset sheet_x_mm=20 --tape-sigma-mm 0.01 --hole-sigma-mm 0 "
                "-o holes.json")
                .code,
            0);
  const grid::files::ReadHoles made = grid::files::read_holes(folder_ / "holes.json");
  int edges = 0;
  for (const grid::HoleDistance& distance : made.holes.distances) {
    if (!distance.edge) continue;
    ++edges;
    const double longer = distance.edge == grid::SheetEdge::right  ? 20.0
                          : distance.edge == grid::SheetEdge::left ? -20.0
                                                                   : 0.0;
    EXPECT_NEAR(distance.distance_mm - commanded_mm(made.holes, distance), longer, 0.05)
        << "five sigmas of the tape";
  }
  EXPECT_GT(edges, 3);
  const Outcome without =
      run("simulate --machine " + classic_ + " --holes 9 --offset sheet_x_mm=20 -o none.json");
  EXPECT_EQ(without.code, 3);
  EXPECT_THAT(without.err, HasSubstr("without --edges"));
  EXPECT_FALSE(exists("none.json"));
}

TEST_F(HolesCommands, PassesStopWhereTheNextWouldNotPay) {
  const Outcome passes = run("passes --machine " + classic_ + " --passes 4 --seed 2");
  EXPECT_EQ(passes.code, 0) << passes.err;
  EXPECT_THAT(passes.out, HasSubstr("Stopped: one more pass would take only"));
  const Outcome files = run("passes " + holes_ + " " + holes_ + " " + holes_ + " -o map.json");
  EXPECT_EQ(files.code, 0) << files.err;
  EXPECT_TRUE(exists("map.json"));
}

TEST_F(HolesCommands, TheCertificateIsOnePage) {
  ASSERT_EQ(run("fit " + holes_ + " -o map.json").code, 0);
  ASSERT_EQ(run("report map.json --certificate -o certificate.html").code, 0);
  EXPECT_THAT(content_of(folder_ / "certificate.html"),
              AllOf(HasSubstr("class=\"one-sheet\""),
                    HasSubstr("95 % interval"),
                    HasSubstr("What was measured"),
                    HasSubstr("The machine's settings"),
                    HasSubstr("What remains")));
}

TEST_F(HolesCommands, DiagnoseNamesTheCauseAndWritesEveryFile) {
  const std::string asked =
      "diagnose " + holes_ + " -o d.json --report d.html --extended-machine m2.json";
  const Outcome found = run(asked);
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out,
              AllOf(StartsWith("Your machine misses by about "),
                    HasSubstr("Most likely the chain's links are worn"),
                    HasSubstr("Error of distances left out, mm"),
                    HasSubstr("all the distances of each of 9 holes"),
                    HasSubstr("No error at the border is given: without the distances that end at "
                              "an outermost hole too few would be left."),
                    Not(HasSubstr("sheet laid right by")),
                    Not(HasSubstr("points"))));
  const std::string file = content_of(folder_ / "d.json");
  EXPECT_THAT(file,
              AllOf(HasSubstr("\"observations\": \"distances\""),
                    HasSubstr("\"verdict\": \"named\""),
                    HasSubstr("\"stated_tape\": {\"tape_sigma_mm\": 0.5"),
                    HasSubstr("a tape has one scale whichever way it is held")));
  EXPECT_THAT(content_of(folder_ / "d.html"),
              AllOf(HasSubstr("What it does to the distances"),
                    HasSubstr("0.5 mm a reading of the tape and 0.3 mm a hole"),
                    HasSubstr("Does the name hang on a few distances?"),
                    HasSubstr("Every good distance, divided by their rms"),
                    HasSubstr("No error at the border is given"),
                    Not(HasSubstr("Over one sprocket turn"))));
  EXPECT_THAT(content_of(folder_ / "m2.json"), HasSubstr("\"effect\": \"chain_pitch_error\""));
  // The file is sufficient for the page, and for programs that request it on standard output.
  EXPECT_EQ(run("report d.json -o again.html").code, 0);
  EXPECT_THAT(content_of(folder_ / "again.html"), HasSubstr("What it does to the distances"));
  EXPECT_EQ(run("diagnose " + holes_ + " --json").out, file);
  ASSERT_EQ(run(asked).code, 0);
  EXPECT_EQ(content_of(folder_ / "d.json"), file);
  // Named with certainty: there is nothing to measure next.
  const Outcome next = run("plan " + holes_ + " --after d.json");
  EXPECT_EQ(next.code, 0) << next.err;
  EXPECT_THAT(next.err, HasSubstr("Nothing more needs measuring"));
}

TEST_F(HolesCommands, DiagnoseSaysWhatToMeasureNext) {
  ASSERT_EQ(run("simulate --machine " + classic_ +
                " --holes 9 --distances 14 --draw-settings --effect "
                "chain_pitch_error:both:elongation=0.0012 --seed 2 -o made.json")
                .code,
            0);
  const Outcome found = run("diagnose made.json -o d.json --report d.html");
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("What to measure next (chaintrue plan HOLES --after"));
  EXPECT_THAT(content_of(folder_ / "d.html"), HasSubstr("to be measured"));
  const Outcome next = run("plan made.json --after d.json --svg next.svg");
  ASSERT_EQ(next.code, 0) << next.err;
  EXPECT_THAT(next.out,
              AllOf(HasSubstr("\"distances\": add, each null filled in"),
                    HasSubstr("\"distance_mm\": null")));
  EXPECT_TRUE(exists("next.svg"));
  const Outcome other = run("plan " + holes_ + " --after d.json");
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("was made from other holes"));
}

// A machine on four belts is recognised by its anchors, not by the word anywhere in the file.
TEST_F(HolesCommands, AHoleMayBeCalledAnchors) {
  std::string text = content_of(holes_);
  for (std::size_t at = text.find("\"A\""); at != std::string::npos; at = text.find("\"A\"", at))
    text.replace(at, 3, "\"anchors\"");
  write("anchors.json", text);
  const Outcome fit = run("fit anchors.json -o map.json");
  EXPECT_EQ(fit.code, 0) << fit.err;
  EXPECT_EQ(run("diagnose anchors.json").code, 0);
}

TEST_F(HolesCommands, SimulatedHolesHaveAnAnswer) {
  const Outcome made = run("simulate --machine " + classic_ +
                           " --holes 6 --bad-points 2 --bad-size-mm 30 --offset motor_left_x_mm=4 "
                           "--name six --seed 2 -o six.json --answer answer.json");
  ASSERT_EQ(made.code, 0) << made.err;
  const auto answer = grid::files::Json::parse(content_of(folder_ / "answer.json"));
  EXPECT_EQ(answer["bad_distances"].size(), 2U);
  EXPECT_EQ(answer["points"].size(), 6U);
  EXPECT_EQ(answer["settings"][0]["setting"], "motor_left_x_mm");
  // The offset is added to the stated value and subtracted again: to the last bits of some 1500 mm.
  EXPECT_NEAR(answer["settings"][0]["offset"].get<double>(), 4.0, 1e-9);
  EXPECT_EQ(grid::files::Json::parse(content_of(folder_ / "six.json"))["name"], "six");
}

TEST_F(HolesCommands, AMapOfHolesEndsAsAsked) {
  ASSERT_EQ(run("fit " + holes_ + " --outside refuse -o map.json").code, 0);
  EXPECT_THAT(content_of(folder_ / "map.json"), HasSubstr("\"refuse\""));
}

TEST_F(HolesCommands, DiagnoseRefusesWhatIsSaidOfPointsAlone) {
  const Outcome refused = run("diagnose " + holes_ +
                              " --corrected-grid g.json --held-out other.json --assume-order rows "
                              "-o d.json");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("--corrected-grid"),
                    HasSubstr("--held-out"),
                    HasSubstr("--assume-order"),
                    HasSubstr("to be left out of holes")));
  EXPECT_FALSE(exists("d.json"));
  write("few.csv",
        "hole,x_mm,y_mm\nA,-900,400\nB,900,400\nC,900,-400\nD,-900,-400\nfrom,to,distance_mm\n"
        "A,B,1801\nB,C,800\nC,D,1799\nD,A,800\nA,C,1970\nB,D,1970\n");
  const Outcome few = run("diagnose few.csv --machine " + classic_ + " -o d.json");
  EXPECT_EQ(few.code, 3);
  EXPECT_THAT(few.err,
              AllOf(HasSubstr("6 distances are too few to name a cause"),
                    HasSubstr("Cut more holes and measure 2")));
  EXPECT_FALSE(exists("d.json"));
  const Outcome machineless = run("diagnose few.csv");
  EXPECT_EQ(machineless.code, 3);
  EXPECT_THAT(machineless.err, HasSubstr("give --machine"));
  // A tape zero offset of 40 mm that was not stated.
  const Outcome tape_zero = run("diagnose " + holes_ + " --hook-offset-mm -40");
  EXPECT_EQ(tape_zero.code, 3);
  EXPECT_THAT(tape_zero.err, HasSubstr("all distances are about 40 mm longer than commanded"));
}

TEST_F(HolesCommands, BadInputExitsWithThreeAndWritesNothing) {
  write("bad.csv", "hole,x_mm,y_mm\nA,-900,400\nB,900,400\nfrom,to,distance_mm\nA,Q,1800\n");
  const Outcome bad = run("fit bad.csv --machine " + classic_ + " -o map.json");
  EXPECT_EQ(bad.code, 3);
  EXPECT_THAT(bad.err, HasSubstr("a hole that was cut"));
  EXPECT_FALSE(exists("map.json"));
  write("list.csv",
        "hole,x_mm,y_mm\nA,-900,400\nB,900,400\nC,900,-400\nD,-900,-400\nfrom,to,distance_mm\n"
        "A,B,1801\nB,C,800\nC,D,1799\nD,A,800\nA,C,1970\nB,D,1970\n");
  const Outcome machineless = run("fit list.csv -o map.json");
  EXPECT_EQ(machineless.code, 3);
  EXPECT_THAT(machineless.err, HasSubstr("give --machine"));
  const Outcome options =
      run("plan --machine " + classic_ + " --holes 99 --tape-sigma-mm 0 -o list2.csv");
  EXPECT_EQ(options.code, 3);
  EXPECT_THAT(options.err, AllOf(HasSubstr("--holes"), HasSubstr("--tape-sigma-mm")));
  EXPECT_FALSE(exists("list2.csv"));
}

}  // namespace
}  // namespace chaintrue
