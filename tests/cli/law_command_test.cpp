// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// --law: a pattern that no listed cause makes becomes a file of a cause, which later diagnoses name; and
/// what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue::law_command {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

const std::string kFixtures = CHAINTRUE_FIXTURES;
const std::string kClassic = " --machine " + kFixtures + "/machines/classic.json";
const std::string kNoise = " --repeats 6 --length-noise-mm 0.05 --position-noise-mm 0.05 --order random";

/// A session with a wave of half a turn in the left chain; what it was made with stands in its own file
/// alone, so that a diagnosis on the classic machine knows nothing of it.
std::string wave(const std::string& grid, int seed, const std::string& file) {
  return "simulate" + kClassic + " --effects " + kFixtures + "/effects/second_harmonic.json --grid " + grid +
         kNoise + " --effect second_harmonic:left:amplitude_mm=0.2,phase_rad=1.2 --seed " +
         std::to_string(seed) + " -o " + file;
}

class LawCommand : public testing_support::CommandFixture {};

TEST_F(LawCommand, ALawBecomesACauseThatASecondSessionNames) {
  ASSERT_EQ(run(wave("9x6", 3, "first.json")).code, 0) << content_of(folder_ / "err.txt");
  const Outcome first = run("diagnose first.json" + kClassic + " -o d.json --law law.json");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out,
              AllOf(HasSubstr("A wave of 0.199 +- 0.011 mm"),
                    HasSubstr("over the left chain's length with period 31."),
                    HasSubstr("in the left chain: "),
                    HasSubstr("a hint: Its period is near half a turn of the sprocket (31.8 mm)")));
  EXPECT_THAT(content_of(folder_ / "d.json"),
              AllOf(HasSubstr("\"laws\""), HasSubstr("\"length_left\""), HasSubstr("\"period_mm\"")));
  // A diagnosis is read again with its laws.
  EXPECT_THAT(run("report d.json -o again.html").code, 0);
  EXPECT_THAT(content_of(folder_ / "again.html"), HasSubstr("over the left chain"));
  ASSERT_EQ(run(wave("10x7", 4, "second.json")).code, 0);
  const Outcome second = run("diagnose second.json" + kClassic + " --effects law.json");
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(second.out, HasSubstr("Most likely a cause without a name"));
  EXPECT_EQ(second.out.find("What the rest looks like"), std::string::npos);
}

TEST_F(LawCommand, WhereThereIsNoLawNothingIsWritten) {
  ASSERT_EQ(run("simulate" + kClassic + " --grid 7x4" + kNoise + " --seed 5 -o plain.json").code, 0);
  const Outcome found = run("diagnose plain.json -o d.json --law law.json");
  EXPECT_EQ(found.code, 4);
  EXPECT_THAT(found.out, HasSubstr("Nothing is found"));
  EXPECT_THAT(found.err,
              HasSubstr("plain.json: No file of a law is made: no law is likelier than none with these "
                        "readings."));
  EXPECT_FALSE(exists("law.json"));
  EXPECT_TRUE(exists("d.json"));
}

TEST_F(LawCommand, HolesThatFollowNoneSaySo) {
  const Outcome found =
      run("diagnose " + kFixtures + "/holes/nine_holes.json -o d.json --law law.json");
  EXPECT_EQ(found.code, 4);
  EXPECT_THAT(found.err, HasSubstr("No file of a law is made: no law is likelier than none"));
  EXPECT_FALSE(exists("law.json"));
}

TEST_F(LawCommand, BeltsHaveNoFileOfOne) {
  const Outcome found =
      run("diagnose " + kFixtures + "/belts/thirty_one_places.json --law law.json");
  EXPECT_EQ(found.code, 3);
  EXPECT_THAT(found.err,
              HasSubstr("--law: found law.json, expected to be left out of belts: a cause of your own acts on chains"));
}

}  // namespace
}  // namespace chaintrue::law_command
