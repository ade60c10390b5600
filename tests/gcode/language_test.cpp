// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The language: what is accepted beyond LinuxCNC's snippets, and what is rejected, with its line,
/// column and reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/gcode/program_events.hpp"
#include "tools/gcode/moves.hpp"

namespace chaintrue::gcode {
namespace {

using testing::HasSubstr;

std::vector<Move> moves_of(const std::string& text, const Dialect& dialect = {}) {
  auto source = LineSource::from_text(text);
  const auto moves = read_moves(source, dialect);
  if (!moves) {
    ADD_FAILURE() << text << ": " << moves.error().message();
    return {};
  }
  return *moves;
}

struct Refusal {
  std::string text;
  std::string message;  // whole
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.text; }

class Refused : public testing::TestWithParam<Refusal> {};

TEST_P(Refused, WithLineAndReason) {
  auto source = LineSource::from_text(GetParam().text);
  Dialect dialect;
  dialect.step_budget = 10000;
  const auto moves = read_moves(source, dialect);
  ASSERT_FALSE(moves);
  EXPECT_EQ(moves.error().message(), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Language,
    Refused,
    testing::Values(
        Refusal{"G21\nG41 D1\n",
                "line 2, column 2: G41: cutter compensation needs the tool table, which is not "
                "known; let the CAM program "
                "offset the path (unsupported_code)"},
        Refusal{"G51 X2", "line 1, column 2: G51: scaling is not supported (unsupported_code)"},
        Refusal{"G68 X0 Y0 R45",
                "line 1, column 2: G68: coordinate rotation by G68 is not supported; G10 L2 R is "
                "(unsupported_code)"},
        Refusal{"F100\nG5 X1 Y1",
                "line 2, column 2: G5: splines are not supported; let the CAM program write lines "
                "and arcs (unsupported_code)"},
        Refusal{"G33 X1 K1",
                "line 1, column 2: G33: threading follows a spindle encoder, which is not "
                "supported (unsupported_code)"},
        Refusal{"F100\nG38.2 X5",
                "line 2: probing sideways (X, Y) ends at a place that only the machine knows "
                "(unsupported_code)"},
        Refusal{"F10\nG0 Z5\nG38.2 Z-5\nG92 Z0",
                "line 4, column 5: after probing or G53 only the machine knows its height, so Z cannot be "
                "set from it here (unsupported_code)"},
        Refusal{"M190 S60", "line 1, column 2: M190 is not known (unknown_code)"},
        Refusal{"F100 G1 X1 E2",
                "line 1, column 12: an E word (the extruder of a 3D printer) has no meaning on a "
                "router (unsupported_axis)"},
        Refusal{"G1 X1,5 F5", "line 1, column 6: ',' begins no word here (bad_character)"},
        Refusal{"N3 G1 X5*97",
                "line 1, column 9: the checksum is 97, but the line's is 102 (bad_checksum)"},
        Refusal{"o1 while [1]\no1 endwhile\n",
                "line 1: the program has taken 10000 steps in loops, subroutines and cycles "
                "without coming to its end (step_budget)"},
        Refusal{"o1 while [1]\nG0 X1\n", "line 1: the loop or condition o1 has no end (bad_flow)"},
        Refusal{"o<other_file> call",
                "line 1, column 1: the subroutine o<other_file> does not stand in this file; other "
                "files are not read (bad_flow)"},
        Refusal{"M99", "line 1: M99 in the main program repeats it for ever (bad_flow)"},
        Refusal{
            "o1 sub\no1 call\no1 endsub\no1 call",
            "line 2, column 1: subroutines call each other more than 10 levels deep (bad_flow)"},
        Refusal{std::string("G0 X1\nG\0 0", 10),
                "line 2, column 2: a zero byte stands here: the file is not plain text (UTF-16, or "
                "no G-code at all) (not_text)"},
        Refusal{"G0 X[" + std::string(100, '[') + "1",
                "line 1, column 37: the expression is nested too deeply (bad_expression)"},
        Refusal{"G0 X99999999999",
                "line 1, column 4: X99999999999 is out of range (number_out_of_range)"},
        Refusal{"G0 X[10**400]",
                "line 1, column 8: the result is too large for a number (arithmetic)"},
        Refusal{std::string(5000, 'X'),
                "line 1: the line is longer than 4096 characters (line_too_long)"},
        Refusal{"F9\nG2 X1 I.5 P2000",
                "line 2, column 11: P, the number of turns, is a whole number from 1 to 1000 "
                "(bad_arc)"}));

TEST(Language, ReadsNumbersInEveryForm) {
  for (const char* text : {"G1 F100 X10.5",
                           "G1F100X10.5",
                           "g 1 f 1 0 0 x 1 0 . 5",
                           "N10 G01 F100. X+10.5 (c)",
                           "N10G1X10.50F100;c",
                           "/G1 F100 X10.5",
                           "\xEF\xBB\xBFG1 F100 X10.5",
                           "G1 F100 X[21/2]",
                           "#1=10.5\nG1 F100 X#1",
                           "%\nG1 F100 X10.5\n%\nnot G-code at all",
                           "\tG1\tF100\tX10.5\r",
                           "G1 F100 X10.5*67"}) {
    SCOPED_TRACE(text);
    const auto moves = moves_of(text);
    ASSERT_EQ(moves.size(), 1U);
    EXPECT_EQ(moves[0].to.x_mm, 10.5);
    EXPECT_EQ(moves[0].feed.value, 100.0);
  }
}

TEST(Language, EndsLinesLikeEverybody) {
  for (const char* text : {"G0 X1\nG0 X2\nG0 X3",
                           "G0 X1\r\nG0 X2\r\nG0 X3\r\n",
                           "G0 X1\rG0 X2\rG0 X3\r",
                           "G0 X1\r\r\nG0 X2\r\r\nG0 X3"}) {
    const auto moves = moves_of(text);
    ASSERT_EQ(moves.size(), 3U);
    EXPECT_EQ(moves[2].line, 3U);
    EXPECT_EQ(moves[2].to.x_mm, 3.0);
  }
}

/// The window is 256 KiB: lines, CRLF and loops across its edge.
TEST(Language, ReadsAcrossTheWindowOfTheFile) {
  std::string text = "#1=0\no1 while [#1 lt 3]\n#1=[#1+1]\n";
  std::size_t expected = 0;
  while (text.size() < 900 * 1024) {
    text += "G0 X" + std::to_string(expected % 1000) + " Y1\r\n";
    ++expected;
  }
  text += "o1 endwhile\n";
  const auto moves = moves_of(text);
  ASSERT_EQ(moves.size(), 3 * expected);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    ASSERT_EQ(moves[i].to.x_mm, static_cast<double>(i % expected % 1000));
    ASSERT_EQ(moves[i].line, 4 + i % expected);
  }
}

TEST(Language, LeavesOutDeletableLinesWhenAsked) {
  Dialect dialect;
  dialect.skip_deletable_blocks = true;
  EXPECT_EQ(moves_of("G0 X1\n/G0 X2\nG0 X3", dialect).size(), 2U);
}

TEST(Language, NeverTruncatesADottedCode) {
  // Read as G91, the second move would go to 20.
  const auto moves = moves_of("G91.1\nG0 X10\nG0 X10");
  EXPECT_EQ(moves[1].to.x_mm, 10.0);
}

TEST(Language, RunsProgramsAndLoops) {
  const auto moves = moves_of("M98 P200 L2\nM2\nO200\nG91 G0 X1\nG90\nM99\n");
  ASSERT_EQ(moves.size(), 2U);
  EXPECT_EQ(moves[1].to.x_mm, 2.0);
  const auto loop = moves_of(
      "#1=0\no1 do\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\no3 if [#1 gt 4]\no1 "
      "break\no3 endif\nG0 X#1\no1 while [1]\n");
  ASSERT_EQ(loop.size(), 3U);  // 1, 3, 4
  EXPECT_EQ(loop[0].to.x_mm, 1.0);
  EXPECT_EQ(loop[1].to.x_mm, 3.0);
  EXPECT_EQ(loop[2].to.x_mm, 4.0);
  const auto value =
      moves_of("o1 sub\no1 return [#1 * 2]\no1 endsub\no1 call [21]\nG0 X#<_value>\n");
  ASSERT_EQ(value.size(), 1U);
  EXPECT_EQ(value[0].to.x_mm, 42.0);
}

TEST(Language, PassesWordsInNistOrder) {
  ProgramEvents events;
  ASSERT_TRUE(run_text("G21 M3 M6 T4 S1000 M8\nG4 P0.5\nG43 H4\nG64 P0.1\nM0\nM30\n", events));
  std::vector<std::string> words;
  for (const PassedWord& word : events.words) words.push_back(word.text);
  EXPECT_THAT(
      words,
      testing::ElementsAre("S1000", "T4", "M6", "M3", "M8", "G4 P0.5", "G43 H4", "G64 P0.1", "M0"));
  EXPECT_EQ(events.end_word, "M30");
}

TEST(Language, NotesWhatOtherControllersDoOtherwise) {
  ProgramEvents events;
  ASSERT_TRUE(run_text("G20 F10\nG91.1\nG28\n/G4 P1\n", events));
  std::vector<std::string> names;
  for (const Note& note : events.notes) names.emplace_back(note.name);
  EXPECT_THAT(names,
              testing::UnorderedElementsAre("feed_before_units",
                                            "dotted_code",
                                            "home_assumed",
                                            "deletable_line",
                                            "dwell_unit",
                                            "no_program_end"));
}

TEST(Language, KeepsFeedsOfBothModes) {
  const auto moves = moves_of("G20\nG1 X1 F10\nG21 X0\nG93 X10 F2\n");
  EXPECT_DOUBLE_EQ(moves[0].feed.value, 254.0);
  EXPECT_DOUBLE_EQ(moves[1].feed.value, 254.0);
  EXPECT_EQ(moves[2].feed.mode, FeedMode::inverse_time);
  EXPECT_DOUBLE_EQ(moves[2].feed.value, 2.0);
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

}  // namespace
}  // namespace chaintrue::gcode
