// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The language beyond fixtures/gcode/corpus: notes by name, and messages. Refusals, ends of lines and
/// words: tests/cli/cases/gcode_programs.cases.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/gcode/program_events.hpp"

namespace chaintrue::gcode {
namespace {

TEST(Language, NotesDifferencesBetweenControllers) {
  ProgramEvents events;
  ASSERT_TRUE(run_text("G20 F10\nG91.1\nG28\n/G4 P1\n", events));
  std::vector<std::string> names;
  for (const Note& note : events.notes) names.emplace_back(note.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("feed_before_units", "dotted_code",
                                                   "home_assumed", "state_left", "deletable_line",
                                                   "dwell_unit", "no_program_end"));
}

TEST(Language, WritesOutParametersInMessages) {
  ProgramEvents events;
  ASSERT_TRUE(run_text(
      "#<r>=2\n(debug, r is #<r>, x is #5420, none #<nope>)\n(MSG,as it is #1)\n(plain #1)\n",
      events));
  ASSERT_EQ(events.comments.size(), 3U);
  EXPECT_EQ(events.comments[0].text, " r is 2.000000, x is 0.000000, none ######");
  EXPECT_EQ(events.comments[1].text, "as it is #1");
  EXPECT_FALSE(events.comments[2].message);
}

TEST(Language, KnowsTheToolInTheSpindle) {
  ProgramEvents events;
  ASSERT_TRUE(
      run_text("(print, #5400)\nT3\n(print, #5400)\nM6\n(print, #5400)\nM61 Q7\n"
               "(print, #5400 #<_current_tool>)\n",
               events));
  std::vector<std::string> told;
  for (const auto& comment : events.comments) told.push_back(comment.text);
  EXPECT_THAT(told,
              testing::ElementsAre(" 0.000000", " 0.000000", " 3.000000", " 7.000000 7.000000"));
}

}  // namespace
}  // namespace chaintrue::gcode
