// SPDX-License-Identifier: GPL-3.0-or-later
// chaintrue diagnose, plan --after and their output files: exit codes, streams, all or nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "grid/files/diagnosis_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/machine_file.hpp"
#include "model/effects/effect.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/support/sample_diagnosis.hpp"

namespace chaintrue {
namespace {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

using testing_support::content_of;
using testing_support::Outcome;

class DiagnoseCommand : public testing_support::CommandFixture {
 protected:
  /// 7 x 5 marks, row by row, with these hidden effects.
  void simulate(const std::string& effects, const std::string& more = "") const {
    const Outcome made =
        run("simulate --machine " + machine_ +
            " --grid 7x5 --repeats 6 --length-noise-mm 0.2 --position-noise-mm 0.3 "
            "--seed 5 -o grid.json " +
            effects + " " + more);
    ASSERT_EQ(made.code, 0) << made.err;
  }
  [[nodiscard]] Diagnosis diagnosis() const {
    return grid::files::read_diagnosis(folder_ / "d.json");
  }

  const std::string machine_ = std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json";
};

TEST_F(DiagnoseCommand, NamesAStrongCauseAndWritesEveryFile) {
  simulate("--effect direction_hysteresis:left:half_width_mm=0.9");
  const Outcome answer =
      run("diagnose grid.json -o d.json --report d.html --extended-machine m.json --corrected-grid "
          "c.json");
  EXPECT_EQ(answer.code, 0) << answer.err;
  const Diagnosis found = diagnosis();
  EXPECT_EQ(found.verdict, Verdict::named);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes[0].cause.effect->id, "direction_hysteresis");
  // The terminal shows the same words and numbers.
  EXPECT_THAT(answer.out, HasSubstr(found.sentence));
  for (const char* heading : {"What to do now",
                              "What this does not prove",
                              "Cause\n  direction hysteresis, left: ",
                              "Error of the tool at points left out, mm",
                              "Probabilities",
                              "Settings ",
                              "Looked for, not found"}) {
    EXPECT_THAT(answer.out, HasSubstr(heading));
  }
  EXPECT_THAT(content_of(folder_ / "d.html"),
              HasSubstr("<h2>Error of the tool at points left out, mm</h2>"));
  // Effects that depend on the visit are removed from the data and never added to the machine of a
  // map.
  for (const auto& effect : grid::files::read_machine(folder_ / "m.json").effects)
    EXPECT_NE(effect.effect, "direction_hysteresis");
  const grid::MeasuredGrid before = grid::files::read_grid(folder_ / "grid.json").grid;
  const grid::MeasuredGrid after = grid::files::read_grid(folder_ / "c.json").grid;
  ASSERT_EQ(before.points.size(), after.points.size());
  const double width_mm = found.causes[0].parameters[0].value;
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    // Half the width, with either sign, and the right chain unchanged.
    const double taken_mm = before.points[i].lengths->left_mm - after.points[i].lengths->left_mm;
    EXPECT_NEAR(std::abs(taken_mm), width_mm, 1e-6) << i;  // both files hold all digits
    EXPECT_NEAR(before.points[i].lengths->right_mm, after.points[i].lengths->right_mm, 1e-6) << i;
  }
  EXPECT_EQ(run("fit c.json -o map.json").code, 0);
}

TEST_F(DiagnoseCommand, ThatFindsNothingIsDoneAsWell) {
  simulate("");
  const Outcome answer = run("diagnose grid.json -o d.json");
  EXPECT_EQ(answer.code, 0);
  EXPECT_THAT(diagnosis().causes, IsEmpty());
  EXPECT_THAT(answer.out, Not(HasSubstr("Cause\n")));
}

TEST_F(DiagnoseCommand, GivesTheSameBytesForTheSameSeed) {
  simulate("--effect beam_flex:-:flexibility_mm_per_n=0.02");
  ASSERT_EQ(run("diagnose grid.json --seed 7 -o a.json --report a.html").code, 0);
  const Outcome json = run("diagnose grid.json --seed 7 --json");
  EXPECT_EQ(json.out, content_of(folder_ / "a.json"));
  ASSERT_EQ(run("report a.json -o b.html").code, 0);
  // The two pages differ in the name of their input file.
  std::string direct = content_of(folder_ / "a.html"), later = content_of(folder_ / "b.html");
  const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, from.size(), to);
  };
  replace(direct, "Made from grid.json", "Made from a.json");
  EXPECT_EQ(direct, later);
  const Outcome piped = run("diagnose grid.json --seed 7 -o -");
  EXPECT_EQ(piped.out, content_of(folder_ / "a.json"));
  EXPECT_THAT(piped.err, HasSubstr("Probabilities"));
}

TEST_F(DiagnoseCommand, OfPointsWithoutAnOrderOpensItOnRequestAndSaysSo) {
  simulate("--effect drift:right:rate_mm_per_visit=0.06");
  grid::MeasuredGrid grid = grid::files::read_grid(folder_ / "grid.json").grid;
  // Repeated visits come last, as in the assumed order; rows were simulated from the bottom.
  for (auto& point : grid.points) point.order.reset();
  write("plain.json", grid::files::write_grid(grid));
  ASSERT_EQ(run("diagnose plain.json -o d.json").code, 0);
  const Diagnosis plain = diagnosis();
  EXPECT_TRUE(std::any_of(plain.not_testable.begin(), plain.not_testable.end(), [](const auto& x) {
    return x.cause.effect->id == "drift";
  }));
  const Outcome answer =
      run("diagnose plain.json --assume-order rows -o d.json --corrected-grid c.json");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Diagnosis assumed = diagnosis();
  EXPECT_FALSE(std::any_of(assumed.not_testable.begin(),
                           assumed.not_testable.end(),
                           [](const auto& x) { return x.cause.effect->id == "drift"; }));
  for (const auto& point : assumed.points) EXPECT_TRUE(point.order.has_value());
  // An assumed order is not written as if it were measured.
  for (const auto& point : grid::files::read_grid(folder_ / "c.json").grid.points)
    EXPECT_FALSE(point.order.has_value());
}

TEST_F(DiagnoseCommand, RefusesToAssumeAnOrderThatIsKnown) {
  simulate("");
  const Outcome answer = run("diagnose grid.json --assume-order rows -o d.json");
  EXPECT_EQ(answer.code, 3);
  EXPECT_THAT(answer.err,
              HasSubstr("--assume-order: found rows, expected to be left out, since these points "
                        "say in which order they were visited"));
  EXPECT_FALSE(exists("d.json"));
  EXPECT_EQ(run("diagnose grid.json --assume-order zigzag").code, 2);
}

TEST_F(DiagnoseCommand, RefusesAnOrderOfMarksThatStandInNoLines) {
  ASSERT_EQ(run("simulate --machine " + machine_ + " --random 40 -o grid.json").code, 0)
      << content_of(folder_ / "err.txt");
  grid::MeasuredGrid grid = grid::files::read_grid(folder_ / "grid.json").grid;
  for (auto& point : grid.points) point.order.reset();
  write("plain.json", grid::files::write_grid(grid));
  const Outcome answer = run("diagnose plain.json --assume-order serpentine_columns");
  EXPECT_EQ(answer.code, 3);
  EXPECT_THAT(answer.err, HasSubstr("expected marks that stand in columns; these do not"));
}

TEST_F(DiagnoseCommand, BadInputExitsWithThreeAndWritesNothing) {
  simulate("");
  // A missing folder, given last: the files before it are not written either.
  const Outcome nowhere = run("diagnose grid.json -o d.json --report nowhere/d.html");
  EXPECT_EQ(nowhere.code, 3);
  EXPECT_THAT(nowhere.err, HasSubstr("nowhere/d.html"));
  EXPECT_FALSE(exists("d.json"));
  const Outcome twice = run("diagnose grid.json -o d.json --report ./d.json");
  EXPECT_EQ(twice.code, 3);
  EXPECT_THAT(twice.err, HasSubstr("a file of its own for each output"));
  EXPECT_FALSE(exists("d.json"));
  EXPECT_EQ(run("diagnose nowhere.json -o d.json").code, 3);
  EXPECT_EQ(run("diagnose -o d.json").code, 2);
}

TEST_F(DiagnoseCommand, TellsHowWellItPredictsAnotherGrid) {
  simulate("--effect beam_flex:-:flexibility_mm_per_n=0.02");
  ASSERT_EQ(run("simulate --machine " + machine_ +
                " --grid 6x4 --length-noise-mm 0.2 --position-noise-mm 0.3 --seed 6 -o other.json "
                "--name later --effect beam_flex:-:flexibility_mm_per_n=0.02")
                .code,
            0);
  const Outcome answer = run("diagnose grid.json --held-out other.json -o d.json --report d.html");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const Diagnosis found = diagnosis();
  ASSERT_TRUE(found.transferred.has_value());
  EXPECT_EQ(found.transferred->to, "later");
  EXPECT_EQ(found.transferred->points, 24U);
  EXPECT_LT(found.transferred->extended.rms_mm, found.transferred->uncalibrated.rms_mm);
  EXPECT_THAT(answer.out, HasSubstr("Error of the tool on \"later\", 24 points"));
  EXPECT_THAT(content_of(folder_ / "d.html"),
              HasSubstr("Error of the tool on &quot;later&quot;, 24 points not used here"));
}

TEST_F(DiagnoseCommand, OfDataThatDoNotDoSaysWhatWouldBeNeeded) {
  simulate("");
  const grid::MeasuredGrid sound = grid::files::read_grid(folder_ / "grid.json").grid;
  const auto refused = [&](const grid::MeasuredGrid& grid) {
    write("unfit.json", grid::files::write_grid(grid));
    const Outcome answer = run("diagnose unfit.json -o d.json --report d.html");
    EXPECT_EQ(answer.code, 3);
    EXPECT_EQ(answer.out, "");
    EXPECT_FALSE(exists("d.json") || exists("d.html"));
    return answer.err;
  };
  grid::MeasuredGrid few = sound;
  few.points.resize(5);
  EXPECT_THAT(refused(few), HasSubstr("at least 8"));
  grid::MeasuredGrid without_noise = sound;
  without_noise.noise.reset();
  // First visits only: no two marks within 25 mm of each other.
  std::vector<grid::MeasuredPoint> first_visits;
  for (const auto& point : sound.points) {
    if (std::none_of(first_visits.begin(), first_visits.end(), [&](const auto& other) {
          return std::hypot(other.mark.x_mm - point.mark.x_mm, other.mark.y_mm - point.mark.y_mm) <
                 30.0;
        })) {
      first_visits.push_back(point);
    }
  }
  without_noise.points = first_visits;
  EXPECT_THAT(refused(without_noise), HasSubstr("measure at least six points twice"));
  grid::MeasuredGrid contradictory = sound;
  contradictory.readings = {{grid::ReadingOf::motor_spacing, "", 2900.0, 1.0}};
  EXPECT_THAT(
      refused(contradictory),
      AllOf(HasSubstr("motor_spacing_mm is 2900"), HasSubstr("the machine file says 2978.4")));
}

// plan --after, from a diagnosis with known next measurements.
class PlanAfter : public DiagnoseCommand {
 protected:
  void SetUp() override {
    DiagnoseCommand::SetUp();
    const Diagnosis sample = grid::testing::sample_diagnosis();
    grid::MeasuredGrid grid;
    grid.machine = sample.extended_machine;
    for (const auto& point : sample.points)
      grid.points.push_back({point.mark, point.lengths, std::nullopt, point.order});
    write("d.json", grid::files::write_diagnosis(sample));
    write("grid.json", grid::files::write_grid(grid));
    std::string csv = "x_mm,y_mm,left_mm,right_mm\n";
    for (const auto& point : sample.points) {
      csv += std::to_string(point.mark.x_mm) + "," + std::to_string(point.mark.y_mm) + "," +
             std::to_string(point.lengths.left_mm) + "," + std::to_string(point.lengths.right_mm) +
             "\n";
    }
    write("grid.csv", csv);
  }
};

TEST_F(PlanAfter, ListsWhatToMeasureAndTheLinesToAdd) {
  const Outcome answer = run("plan grid.json --after d.json --svg next.svg");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.out,
            "\"points\": add, each null filled in\n"
            "  {\"x_mm\": -1099.2, \"y_mm\": -499.5, \"left_mm\": null, \"right_mm\": null, "
            "\"order\": 28},\n"
            "  {\"x_mm\": 1150.0, \"y_mm\": 540.0, \"left_mm\": null, \"right_mm\": null, "
            "\"order\": 29},\n"
            "\"readings\": add, each null filled in\n"
            "  {\"what\": \"link_pitch_mm\", \"side\": \"left\", \"value\": null, \"sigma\": "
            "0.001},\n");
  EXPECT_THAT(answer.err,
              AllOf(HasSubstr("  1. Measure the length of 100 links"),
                    HasSubstr("to 0.1 mm; divide it by 100 for the file. A single right name then "
                              "has probability 98 %."),
                    HasSubstr("  3. (1150, 540): Measure a new mark."),
                    HasSubstr("has probability 99.5 %.")));
  const std::string drawing = content_of(folder_ / "next.svg");
  EXPECT_THAT(drawing, AllOf(StartsWith("<svg "), HasSubstr(">2</text>"), HasSubstr(">3</text>")));
}

TEST_F(PlanAfter, SpeaksCsvToACsv) {
  // The CSV has six decimals of the marks: the points are still recognised.
  const Outcome answer = run("plan grid.csv --after d.json");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.out, "x_mm,y_mm,left_mm,right_mm\n-1099.2,-499.5,,\n1150.0,540.0,,\n");
  EXPECT_THAT(answer.err, HasSubstr("A CSV holds no readings"));
}

TEST_F(PlanAfter, RefusesADiagnosisOfOtherPoints) {
  simulate("", "--force");
  const Outcome answer = run("plan grid.json --after d.json -o lines.txt");
  EXPECT_EQ(answer.code, 3);
  EXPECT_THAT(answer.err, HasSubstr("d.json was made from other points than those of grid.json"));
  EXPECT_FALSE(exists("lines.txt"));
}

TEST_F(PlanAfter, NeedsBothOrAMachine) {
  EXPECT_EQ(run("plan --after d.json").code, 2);
  EXPECT_EQ(run("plan grid.json").code, 2);
  EXPECT_EQ(run("plan grid.json --after missing.json").code, 3);
}

TEST_F(DiagnoseCommand, NoNumberToTypeInRestsOnAWeakCause) {
  simulate("--effect chain_pitch_error:left:elongation=0.0012");
  ASSERT_EQ(run("diagnose grid.json -o d.json").code, 0);
  ASSERT_GE(diagnosis().causes.front().probability, 0.9);
  EXPECT_EQ(run("export groundcontrol d.json -o sure.ini").code, 0);
  // The same, a little less sure.
  Diagnosis weak = diagnosis();
  weak.causes.front().probability = 0.72;
  write("weak.json", grid::files::write_diagnosis(weak));
  const Outcome refused = run("export groundcontrol weak.json -o weak.ini");
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(
      refused.err,
      AllOf(HasSubstr("on the left (72 %); to type numbers in, a cause must be at least 90 % sure"),
            HasSubstr("--force goes on all the same")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "weak.ini"));
  EXPECT_EQ(run("export groundcontrol weak.json -o weak.ini --force").code, 0);
  EXPECT_EQ(content_of(folder_ / "weak.ini"), content_of(folder_ / "sure.ini"));
}

TEST_F(DiagnoseCommand, PlainIsTheMapWithoutCausesAndContradictsThem) {
  simulate("--effect chain_pitch_error:left:elongation=0.0012");
  ASSERT_EQ(run("fit grid.json -o usual.json").code, 0);
  ASSERT_EQ(run("fit grid.json --plain -o plain.json").code, 0);
  EXPECT_EQ(content_of(folder_ / "plain.json"), content_of(folder_ / "usual.json"));
  const Outcome both = run("fit grid.json --plain --causes -o both.json");
  EXPECT_EQ(both.code, 3);
  EXPECT_THAT(both.err, HasSubstr("either --plain or --causes"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "both.json"));
}

}  // namespace
}  // namespace chaintrue
