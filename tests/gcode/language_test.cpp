// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The language beyond fixtures/gcode/corpus: columns of refusals, ends of lines, long files, notes,
/// words and messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/gcode/program_events.hpp"

namespace chaintrue::gcode {
namespace {

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
  ProblemName name;
  Place place;
};

/// The corpus has the name and the line of every other refusal (fixtures/gcode/corpus/refused.tsv).
TEST(Language, IsRefusedWithNameLineAndColumn) {
  const Refusal refusals[] = {
      {"G21\nG41 D1\n", ProblemName::unsupported_code, {2, 2}},
      {"F100 G1 X1 E2", ProblemName::unsupported_axis, {1, 12}},
      {"G1 X1,5 F5", ProblemName::bad_character, {1, 6}},
      {"N3 G1 X5*97", ProblemName::bad_checksum, {1, 9}},
      {std::string("G0 X1\nG\0 0", 10), ProblemName::not_text, {2, 2}},
      {"G0 X[" + std::string(100, '[') + "1", ProblemName::bad_expression, {1, 37}},
      {"G0 X[10**400]", ProblemName::arithmetic, {1, 8}},
      {std::string(5000, 'X'), ProblemName::line_too_long, {1, 0}},
      {"o1 while [1]\no1 endwhile\n", ProblemName::step_budget, {1, 0}},
  };
  Dialect dialect;
  dialect.step_budget = 10000;
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.text.substr(0, 40));
    auto source = LineSource::from_text(refusal.text);
    const auto moves = read_moves(source, dialect);
    ASSERT_FALSE(moves);
    EXPECT_EQ(name(moves.error().name), name(refusal.name));
    EXPECT_EQ(moves.error().place.line, refusal.place.line);
    EXPECT_EQ(moves.error().place.column, refusal.place.column);
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
                                            "state_left",
                                            "deletable_line",
                                            "dwell_unit",
                                            "no_program_end"));
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
