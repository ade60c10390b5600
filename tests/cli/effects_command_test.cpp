// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// --effects: a cause of one's own from its file through a simulation, a diagnosis, a map and a part
/// that is cut, without the file once it is in the machine; and what is refused, with its code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue::effects_command {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::Outcome;

const std::string kFixtures = CHAINTRUE_FIXTURES;
const std::string kClassic = " --machine " + kFixtures + "/machines/classic.json";
const std::string kOwn = " --effects " + kFixtures + "/effects/second_harmonic.json";
/// A wave of half a turn that is plain to see.
const std::string kWave =
    "simulate" + kClassic + kOwn +
    " --grid 9x5 --repeats 6 --length-noise-mm 0.05 --position-noise-mm 0.05 "
    "--effect second_harmonic:left:amplitude_mm=0.2,phase_rad=1.2 -o wave.json";

class EffectsCommand : public testing_support::CommandFixture {};

TEST_F(EffectsCommand, ACauseOfOnesOwnIsNamedAndStaysWithTheMachine) {
  ASSERT_EQ(run(kWave).code, 0) << testing_support::content_of(folder_ / "err.txt");
  EXPECT_THAT(testing_support::content_of(folder_ / "wave.json"),
              HasSubstr("\"declared_effects\""));
  const Outcome found =
      run("diagnose wave.json -o d.json --extended-machine machine.json --report d.html");
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out,
              AllOf(HasSubstr("a sprocket is not round"), HasSubstr("change the sprocket")));
  EXPECT_THAT(testing_support::content_of(folder_ / "machine.json"),
              AllOf(HasSubstr("\"declared_effects\""), HasSubstr("amplitude_mm * sin(")));
  EXPECT_EQ(run("plan wave.json --after d.json").code, 0)
      << testing_support::content_of(folder_ / "err.txt");
  EXPECT_EQ(run("report d.json -o again.html").code, 0);
}

TEST_F(EffectsCommand, AMapHonoursItWithoutItsFile) {
  ASSERT_EQ(run(kWave).code, 0);
  ASSERT_EQ(run("fit wave.json -o plain.json").code, 0);
  ASSERT_EQ(run("fit wave.json --causes" + kOwn + " -o map.json").code, 0)
      << testing_support::content_of(folder_ / "err.txt");
  EXPECT_THAT(testing_support::content_of(folder_ / "map.json"),
              HasSubstr("\"effect\": \"second_harmonic\""));
  // A quarter of a wave apart along the left chain: the plain map sees nothing of it.
  const Outcome with = run("query map.json 100 0 108 0 116 0 --json");
  const Outcome without = run("query plain.json 100 0 108 0 116 0 --json");
  EXPECT_EQ(with.code, 0);
  EXPECT_NE(with.out, without.out);
  write("part.nc", "G21 G90 G17\nF600\nG0 X0 Y0\nG1 X100 Y0\nG0 X0 Y0\nM2\n");
  EXPECT_EQ(run("gcode compensate part.nc --map map.json -o cut.nc").code, 0)
      << testing_support::content_of(folder_ / "err.txt");
}

TEST_F(EffectsCommand, TheListShowsIt) {
  const Outcome list = run("effects" + kOwn);
  EXPECT_EQ(list.code, 0);
  EXPECT_THAT(
      list.out,
      AllOf(HasSubstr("declared"), HasSubstr("second_harmonic:left|right:amplitude_mm,phase_rad")));
  const Outcome one = run("effects second_harmonic" + kOwn + kClassic);
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.out, AllOf(HasSubstr("+ amplitude_mm * sin("), HasSubstr("A square of 100 mm")));
  EXPECT_EQ(run("effects second_harmonic").code, 3);
}

TEST_F(EffectsCommand, ABadFileIsRefusedAndNothingIsWritten) {
  ASSERT_EQ(run(kWave).code, 0);
  std::string text = testing_support::content_of(kFixtures + "/effects/second_harmonic.json");
  text.replace(text.find("L0 / turn"), 2, "L1");
  write("bad.json", text);
  for (const std::string line : {"diagnose wave.json --effects bad.json -o d.json",
                                 "fit wave.json --causes --effects bad.json -o d.json",
                                 "effects --effects bad.json"}) {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.code, 3) << line;
    EXPECT_THAT(
        outcome.err,
        HasSubstr(
            "bad.json: line 11, column 43: found L1, expected a name that this formula may use"))
        << line;
    EXPECT_FALSE(exists("d.json"));
  }
  const Outcome made = run("simulate" + kClassic + " --grid 7x4 --effects bad.json -o made.json");
  EXPECT_EQ(made.code, 3);
  EXPECT_FALSE(exists("made.json"));
}

TEST_F(EffectsCommand, AVerbThatCannotUseItSaysSo) {
  ASSERT_EQ(run(kWave).code, 0);
  const Outcome plain = run("fit wave.json" + kOwn + " -o map.json");
  EXPECT_EQ(plain.code, 3);
  EXPECT_THAT(plain.err, HasSubstr("to be left out without --causes"));
  const Outcome sweep = run("sweep " + kFixtures + "/sweeps/quick.json" + kOwn + " -o results");
  EXPECT_EQ(sweep.code, 3);
  EXPECT_THAT(sweep.err, HasSubstr("or --effects without its file"));
  const Outcome belts = run("diagnose " + kFixtures + "/belts/thirty_one_places.json" + kOwn);
  EXPECT_EQ(belts.code, 3);
  EXPECT_THAT(belts.err, HasSubstr("four belts have their own"));
}

}  // namespace
}  // namespace chaintrue::effects_command
