// SPDX-License-Identifier: GPL-3.0-or-later
// Points and distances together, through the command: diagnosis and next measurements.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/files/diagnosis_file.hpp"
#include "grid/files/holes_file.hpp"
#include "model/effects/effect.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using testing_support::content_of;
using testing_support::Outcome;

/// Points and distances of a machine with a slightly yielding beam: they leave a set of causes.
class MixedCommands : public testing_support::CommandFixture {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    const std::string hidden = " --effect beam_flex:-:flexibility_mm_per_n=0.005 --seed 4 -o ";
    ASSERT_EQ(run("simulate --machine " + classic_ +
                  " --grid 5x3 --repeats 6 --length-noise-mm 0.2 --position-noise-mm 0.3" + hidden +
                  "g.json")
                  .code,
              0);
    ASSERT_EQ(
        run("simulate --machine " + classic_ + " --holes 9 --distances 14" + hidden + "h.json")
            .code,
        0);
  }

  /// The beam's probability with this reading in the holes' file.
  double probability_with(const grid::ExtraReading& reading) {
    grid::MeasuredHoles set = grid::files::read_holes(folder_ / "h.json").holes;
    set.readings.push_back(reading);
    write("more.json", grid::files::write_holes(set));
    EXPECT_EQ(run("diagnose g.json --with more.json -o again.json --force").code, 0);
    const auto found = grid::files::read_diagnosis(folder_ / "again.json");
    for (const auto& cause : found.causes) {
      if (cause.cause.effect->id == "beam_flex") return cause.probability;
    }
    ADD_FAILURE() << "the beam is not named: " << found.sentence;
    return 0.0;
  }

  const std::string fixtures_ = CHAINTRUE_FIXTURES;
  const std::string classic_ = fixtures_ + "/machines/classic.json";
  const std::string holes_ = fixtures_ + "/holes/nine_holes.json";
};

TEST_F(MixedCommands, PlanSaysWhatToMeasureNextAndInWhichFile) {
  const Outcome found = run("diagnose g.json --with h.json -o d.json --report d.html");
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("(chaintrue plan GRID --with HOLES --after diagnosis.json)"));
  EXPECT_THAT(content_of(folder_ / "d.html"),
              HasSubstr("holes and distances into the holes' file, readings into the"));
  const Outcome next = run("plan g.json --with h.json --after d.json --svg next.svg");
  ASSERT_EQ(next.code, 0) << next.err;
  EXPECT_THAT(next.out,
              AllOf(StartsWith("# g.json\n\"points\": add, each null filled in\n"),
                    HasSubstr("\"left_mm\": null"),
                    HasSubstr("\"readings\": add, each null filled in\n  {\"what\": "
                              "\"tape_error_mm_per_m\", \"side\": \"x\", \"value\": null, "
                              "\"sigma\": 0.15},\n  {\"what\": \"link_pitch_mm\", \"side\": "
                              "\"left\", \"value\": null, \"sigma\": 0.001},"),
                    HasSubstr("# h.json\n\"holes\": cut and add\n  {\"name\": \"N1\""),
                    HasSubstr("{\"from\": \"N1\", \"to\": \"A\", \"distance_mm\": null}")));
  EXPECT_THAT(next.err, HasSubstr("  2. Measure the length of 100 links of the left chain, pulled taut, to 0.1 mm;"));
  EXPECT_THAT(content_of(folder_ / "next.svg"), HasSubstr("among 30 measured"));
  // One of the list is more informative than one that is not in it.
  const double chosen = probability_with({grid::ReadingOf::link_pitch, "left", 6.35, 0.001});
  const double other = probability_with({grid::ReadingOf::ring_radius, "", 139.1, 0.5});
  EXPECT_GT(chosen, other);
}

TEST_F(MixedCommands, ThePageShowsReadingsOfBothKinds) {
  grid::MeasuredHoles set = grid::files::read_holes(folder_ / "h.json").holes;
  set.distances[3].distance_mm += 25.0;
  write("bad.json", grid::files::write_holes(set));
  const Outcome found = run("diagnose g.json --with bad.json --report d.html");
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out, AllOf(HasSubstr("mm too long ("), Not(HasSubstr("  point 4:"))));
  EXPECT_THAT(content_of(folder_ / "d.html"),
              AllOf(HasSubstr("21 points and 14 distances"),
                    HasSubstr("What it does to the tool"),
                    HasSubstr("The distances, read minus expected"),
                    HasSubstr("Against the tape's direction"),
                    HasSubstr("<h2>Bad readings: measure them again</h2>"),
                    HasSubstr("mm too long ("),
                    Not(HasSubstr("up of its mark")),
                    HasSubstr("Both chains at every good point, and every good distance"),
                    HasSubstr("At the border the outermost points were left out."),
                    ContainsRegex("mm a chain and 0.3 mm a (<abbr [^>]*>)?mark"),
                    HasSubstr("mm a reading of the tape and 0.3 mm a hole")));
}

TEST_F(MixedCommands, PlanAsksForAllTheFilesOfADiagnosis) {
  ASSERT_EQ(run("diagnose g.json --with h.json -o d.json").code, 0);
  const Outcome part = run("plan g.json --after d.json -o lines.txt");
  EXPECT_EQ(part.code, 3);
  EXPECT_THAT(part.err,
              HasSubstr("d.json was made from points and distances together: name its other files "
                        "with --with"));
  const Outcome other = run("plan g.json --with " + holes_ + " --after d.json -o lines.txt");
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("was made from other holes than those of g.json and"));
  EXPECT_FALSE(exists("lines.txt"));
  EXPECT_EQ(run("plan --machine " + classic_ + " --with h.json").code, 2);
}

}  // namespace
}  // namespace chaintrue
