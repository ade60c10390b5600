// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that accept belts, through the command: from a pasted log to the lines to paste back.
#include <gmock/gmock.h>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/json_text.hpp"
#include "tests/belts/simulated_belts.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing_support::content_of;
using testing_support::Outcome;

class BeltCommands : public testing_support::CommandFixture {
 protected:
  const std::string fixtures_ = CHAINTRUE_FIXTURES;
  const std::string log_ = fixtures_ + "/good/maslow4_log.txt";
  const std::string settings_ = " --settings " + fixtures_ + "/machines/maslow.yaml";
  const std::string belts_ = fixtures_ + "/belts/thirty_one_places.json";
};

TEST_F(BeltCommands, FromTheLogToTheLinesToPaste) {
  const Outcome import = run("import maslow4 " + log_ + settings_ + " -o belts.json");
  ASSERT_EQ(import.code, 0) << import.err;
  EXPECT_THAT(import.err,
              AllOf(HasSubstr("31 points read."),
                    HasSubstr("Assumed: lengths that are level"),
                    HasSubstr("Next: chaintrue fit belts.json -o anchors.json")));
  const Outcome fit = run("fit belts.json -v -o anchors.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err,
              AllOf(HasSubstr("31 places, 124 readings: one belt's reading is off by 0.23 mm"),
                    HasSubstr("(Find Anchors fit: rms) that is 0.61 mm"),
                    HasSubstr("Its own message said rms 0.61 mm and max 1.53 mm."),
                    HasSubstr("Scale: not known, for belts cannot tell it."),
                    HasSubstr("Tape the distance from the "),
                    HasSubstr("Lower belts as the upper two predict them"),
                    HasSubstr("Next: chaintrue export maslow4 anchors.json")));
  const Outcome lines = run("export maslow4 anchors.json");
  ASSERT_EQ(lines.code, 0) << lines.err;
  EXPECT_THAT(lines.out, StartsWith("$/kinematics/MaslowKinematics/tlX=-31."));
  EXPECT_THAT(
      lines.out,
      AllOf(HasSubstr("\n$/kinematics/MaslowKinematics/brY=0.00\n"), Not(HasSubstr("Scale"))));
  EXPECT_THAT(lines.err, HasSubstr("Maslow_Scale_X and Maslow_Scale_Y stay as they are"));
}

TEST_F(BeltCommands, ADiagnosisBeginsWithTheNumberOfTheFit) {
  const Outcome fit = run("fit " + belts_ + " -o anchors.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  const std::string number = fit.err.substr(0, fit.err.find(" mm. With") + 4);
  ASSERT_THAT(number, StartsWith("Your machine misses by about "));
  const Outcome found = run("diagnose " + belts_);
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out, StartsWith(number));
}

TEST_F(BeltCommands, TheFixtureIsWhatImportMakes) {
  ASSERT_EQ(run("import maslow4 " + log_ + settings_ + " -o belts.json").code, 0);
  EXPECT_EQ(content_of(folder_ / "belts.json"), content_of(belts_));
}

TEST_F(BeltCommands, ATapedDistanceChangesTheScalesToPaste) {
  grid::SimulatedBelts set = grid::simulate({.seed = 3});
  const auto& a = set.truth.anchors;
  set.belts.distances.push_back({model::Belt::bl, model::Belt::br, 1.004 * a.br.x_mm, 0.5});
  write("belts.json", grid::files::write_belts(set.belts));
  const Outcome fit = run("fit belts.json -o anchors.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err,
              AllOf(HasSubstr("Scale: by the tape everything is 1.00"),
                    HasSubstr("the bottom left anchor to the bottom right anchor: taped")));
  const Outcome lines = run("export maslow4 anchors.json");
  EXPECT_THAT(lines.out,
              AllOf(HasSubstr("\n$/Maslow_Scale_X=0.99"), HasSubstr("\n$/Maslow_Scale_Y=0.99")));
  // The scale in force is not changed.
  const auto found =
      grid::files::parse_anchors(content_of(folder_ / "anchors.json"), "anchors.json");
  set.belts.machine.scale_x = set.belts.machine.scale_y = 1.0 / found.fit.scale->factor;
  write("scaled.json", grid::files::write_belts(set.belts));
  ASSERT_EQ(run("fit scaled.json -o scaled_anchors.json").code, 0);
  const Outcome same = run("export maslow4 scaled_anchors.json");
  EXPECT_THAT(same.out, Not(HasSubstr("Scale")));
  EXPECT_THAT(same.err, HasSubstr("that is in force"));
}

TEST_F(BeltCommands, AFitSaysWhichCausesItsAnchorsGoWith) {
  const Outcome fit = run("fit " CHAINTRUE_FIXTURES "/belts/lower_belts_short.json -o short.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err,
              HasSubstr("Counted in these anchors: one belt is worn, of another make, or runs on another pulley than "
                        "the other three at the bottom left (0.3"));
  EXPECT_THAT(fit.err, HasSubstr(" and one belt is worn"));
  EXPECT_THAT(fit.err, HasSubstr("at the bottom right (0.3"));
  EXPECT_THAT(fit.err, HasSubstr("chaintrue diagnose says what to look at."));
  EXPECT_THAT(run("fit " CHAINTRUE_FIXTURES "/belts/thirty_one_places.json -o again.json").err,
              Not(HasSubstr("Counted in these anchors")));
}

TEST_F(BeltCommands, ADiagnosisHasItsAnchorsToPasteAndSaysWhatNoNumberTakesOut) {
  ASSERT_EQ(run("simulate --belts " + belts_ +
                " --grid 9x9 --effect belt_stretch:-:elongation=0.006 --length-noise-mm 0.3 --seed 5 "
                "-o pulled.json")
                .code,
            0);
  const Outcome fit = run("fit pulled.json -o pulled_anchors.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr(" % longer than they count, and these anchors go with that."));
  EXPECT_THAT(content_of(folder_ / "pulled_anchors.json"), HasSubstr("\"effect\": \"belt_stretch\""));
  // Its own readings agree with them once the stretch is counted.
  EXPECT_EQ(run("check pulled_anchors.json pulled.json").code, 0);
  ASSERT_EQ(run("diagnose pulled.json -o pulled_diagnosis.json").code, 0);
  const Outcome pulled = run("export maslow4 pulled_diagnosis.json");
  ASSERT_EQ(pulled.code, 0) << pulled.err;
  EXPECT_THAT(pulled.out, StartsWith("$/kinematics/MaslowKinematics/tlX="));
  EXPECT_THAT(pulled.err, HasSubstr("No number to paste takes this out: belts, anchors or arms"));
  ASSERT_EQ(run("simulate --belts " + belts_ +
                " --grid 9x9 --effect anchor_height:tr:offset_mm=90 --length-noise-mm 0.1 --seed 6 "
                "-o high.json")
                .code,
            0);
  ASSERT_EQ(run("diagnose high.json -o high_diagnosis.json").code, 0);
  EXPECT_THAT(run("export maslow4 high_diagnosis.json").out,
              HasSubstr("$/kinematics/MaslowKinematics/trZ=1"));  // 56 and some 90 mm
  const Outcome chains = run("export maslow4 " + fixtures_ + "/good/diagnosis_every_key.json");
  EXPECT_EQ(chains.code, 3);
}

TEST_F(BeltCommands, WhatIsLeftOpenIsToldWithWhatToMeasureAndTheLinesToAdd) {
  // Detected, but not distinguished from a belt's scale.
  ASSERT_EQ(run("simulate --belts " + belts_ +
                " --grid 7x6 --effect anchor_height:tr:offset_mm=30 --length-noise-mm 0.4 --seed 1 "
                "-o b.json")
                .code,
            0);
  const Outcome diagnosed = run("diagnose b.json -o d.json --report d.html");
  ASSERT_EQ(diagnosed.code, 0) << diagnosed.err;
  EXPECT_THAT(diagnosed.out, HasSubstr("What to measure next (chaintrue plan BELTS --after"));
  EXPECT_THAT(diagnosed.err, HasSubstr("Next: chaintrue plan b.json --after d.json"));
  EXPECT_THAT(content_of(folder_ / "d.html"), HasSubstr("What to measure next"));
  const Outcome plan = run("plan b.json --after d.json --svg next.svg");
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.out,
              AllOf(HasSubstr("\"points\": add, each null filled in\n  {\"tl_mm\": null"),
                    HasSubstr("\"order\": 42}"),
                    HasSubstr("\"distances\": add, each null filled in\n  {\"from\": "),
                    HasSubstr("\"distance_mm\": null, \"sigma_mm\": 1}")));
  EXPECT_THAT(plan.err,
              AllOf(HasSubstr("Measure, in this order:"),
                    HasSubstr("A single right name then has probability"),
                    HasSubstr("after which the scale is known to"),
                    HasSubstr("Next: chaintrue diagnose b.json -o d.json")));
  EXPECT_TRUE(exists("next.svg"));
  const Outcome other = run("plan " + belts_ + " --after d.json");
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("was made from other readings"));
  EXPECT_EQ(run("plan b.json --after d.json --with " + belts_).code, 3);
}

TEST_F(BeltCommands, AnchorsAnswerQueriesHaveAPageAndAreChecked) {
  ASSERT_EQ(run("fit " + belts_ + " -o anchors.json").code, 0);
  const Outcome query = run("query anchors.json 100 200");
  ASSERT_EQ(query.code, 0) << query.err;
  EXPECT_THAT(query.out,
              StartsWith("x_mm,y_mm,tl_mm,tr_mm,bl_mm,br_mm,tl_sigma_mm,tr_sigma_mm,status\n100,200,"));
  // The upper two, written to a tenth of a micrometre, are inverted to the position.
  const std::string line = query.out.substr(query.out.find('\n') + 1);
  const std::size_t first = line.find(',', 4) + 1;
  const std::size_t second = line.find(',', first) + 1;
  const Outcome back = run("query anchors.json --json --inverse " +
                           line.substr(first, second - first - 1) + " " +
                           line.substr(second, line.find(',', second) - second));
  ASSERT_EQ(back.code, 0) << back.err;
  const auto tool = grid::files::Json::parse(back.out);
  EXPECT_NEAR(tool["x_mm"].get<double>(), 100.0, 0.001);
  EXPECT_NEAR(tool["y_mm"].get<double>(), 200.0, 0.001);
  EXPECT_EQ(run("query anchors.json 9000 0").code, 4);
  EXPECT_EQ(run("query anchors.json 1 2 --frame bed").code, 3);
  ASSERT_EQ(run("report anchors.json -o anchors.html").code, 0);
  EXPECT_THAT(
      content_of(folder_ / "anchors.html"),
      AllOf(HasSubstr("With these anchors"), HasSubstr("belt_frame"), HasSubstr("rests on")));
  EXPECT_EQ(run("report anchors.json --certificate -o c.html").code, 3);
  ASSERT_EQ(run("simulate --belts anchors.json --grid 3x2 --length-noise-mm 0.3 --seed 5 -o new.json")
                .code,
            0);
  const Outcome valid = run("check anchors.json new.json");
  EXPECT_EQ(valid.code, 0) << valid.err;
  EXPECT_THAT(valid.out, StartsWith("The anchors still hold"));
  ASSERT_EQ(run("simulate --belts anchors.json --grid 3x2 --length-noise-mm 0.3 --seed 5 "
                "--offset tr_x_mm=12 -o moved.json")
                .code,
            0);
  EXPECT_EQ(run("check anchors.json moved.json --json").code, 1);
  const Outcome holes = run("check anchors.json " + fixtures_ + "/holes/nine_holes.json");
  EXPECT_EQ(holes.code, 3);
  EXPECT_THAT(holes.err, HasSubstr("chaintrue fit BELTS --with HOLES"));
  const Outcome plan = run("plan --check anchors.json -o points.csv");
  EXPECT_EQ(plan.code, 3);
  EXPECT_THAT(plan.err, HasSubstr("chaintrue query, report, check"));
}

TEST_F(BeltCommands, AProgramIsCheckedForAMaslow4WithoutAMap) {
  write("tool_length.nc", "G21 G90\nG43 H1\nG1 X10 Y10 F500\nM2\n");
  const Outcome check = run("gcode check tool_length.nc --controller maslow4");
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.err, HasSubstr("line 2: note: maslow4 stops with an error at G43"));
  EXPECT_EQ(run("gcode check " + fixtures_ + "/gcode/bracket.nc --controller maslow4").code, 0);
  ASSERT_EQ(run("fit " + fixtures_ + "/grids/seven_by_four.json -o map.json").code, 0);
  const Outcome chains =
      run("gcode check " + fixtures_ + "/gcode/bracket.nc --controller maslow4 --map map.json");
  EXPECT_EQ(chains.code, 3);
  EXPECT_THAT(chains.err, HasSubstr("chaintrue_anchors"));
}

TEST_F(BeltCommands, ABadReadingIsNamedInTurnsOfTheEncoder) {
  grid::SimulatedBelts set = grid::simulate({.seed = 8});
  set.belts.points[17].lengths_mm.tr += 2.0 * 43.975;
  write("belts.json", grid::files::write_belts(set.belts));
  EXPECT_THAT(run("fit belts.json -o anchors.json").err,
              AllOf(HasSubstr("Left out: the top right belt at point 18"),
                    HasSubstr("2 whole turns of the encoder")));
}

TEST_F(BeltCommands, StandardInputAndOutputAndJson) {
  const Outcome piped = run_line("cat " + belts_ + " | " CHAINTRUE_COMMAND " fit - -o -");
  ASSERT_EQ(piped.code, 0) << piped.err;
  EXPECT_THAT(piped.out, HasSubstr("\"chaintrue_anchors\""));
  EXPECT_THAT(piped.err, Not(HasSubstr("Next:")));
  const Outcome json = run("fit " + belts_ + " -o anchors.json --json");
  EXPECT_EQ(json.out, content_of(folder_ / "anchors.json"));
}

TEST_F(BeltCommands, BadInputWritesNothing) {
  const Outcome bad = run("fit " + fixtures_ + "/bad/belts_swapped.json -o anchors.json");
  EXPECT_EQ(bad.code, 3);
  EXPECT_THAT(bad.err, HasSubstr("tl and tr swapped, or bl and br"));
  EXPECT_FALSE(exists("anchors.json"));
  EXPECT_EQ(run("import maslow4 " + fixtures_ + "/bad/maslow4_readings.txt -o belts.json").code, 3);
  EXPECT_EQ(run("import maslow4 " + log_ + " --points 9 -o belts.json").code, 3);
  EXPECT_EQ(run("import maslow4 " + log_ + " --lengths cubits -o belts.json").code, 2);
  EXPECT_FALSE(exists("belts.json"));
  EXPECT_EQ(run("fit " + belts_ + " --surface direct -o anchors.json").code, 3);
  const Outcome twice = run("fit " + belts_ + " --with " + belts_ + " -o anchors.json");
  EXPECT_EQ(twice.code, 3);
  EXPECT_THAT(twice.err, HasSubstr("anchors of two sessions are two fits"));
  EXPECT_FALSE(exists("anchors.json"));
  const Outcome wrong = run("export maslow4 " + fixtures_ + "/machines/classic.json");
  EXPECT_EQ(wrong.code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("chaintrue_anchors"));
}

TEST_F(BeltCommands, SeveralRunsAreListedAndTheLastTaken) {
  const Outcome runs = run("import maslow4 " + fixtures_ + "/good/maslow4_notes.txt -o belts.json");
  ASSERT_EQ(runs.code, 0) << runs.err;
  EXPECT_THAT(runs.err,
              AllOf(HasSubstr("The log holds 2 runs:"),
                    HasSubstr("points 0:5  line 5  Run 1:"),
                    HasSubstr("--run N or --points A:B takes another")));
}

}  // namespace
}  // namespace chaintrue
