// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Words that are passed through: which code they belong to, which are whole numbers, how they are
/// written; and heights that an arc leaves and returns to.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/gcode/formula_target.hpp"
#include "tests/gcode/program_events.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/moves.hpp"
#include "tools/gcode/path_lengths.hpp"
#include "tools/gcode/word_text.hpp"

namespace chaintrue::gcode {
namespace {

using testing::HasSubstr;

std::vector<std::string> words_of(const std::string& text) {
  ProgramEvents events;
  const auto outcome = run_text(text, events);
  EXPECT_TRUE(outcome) << text << ": " << outcome.error().message();
  std::vector<std::string> words;
  for (const PassedWord& word : events.words) words.push_back(word.text);
  return words;
}

std::string refusal_of(const std::string& text) {
  ProgramEvents events;
  const auto outcome = run_text(text, events);
  return outcome ? "accepted" : outcome.error().message();
}

struct Output {
  std::string text;
  std::string message;
};

/// Under the identity, for the ideal controller.
Output compensated(const std::string& program) {
  const PlainKinematics kinematics;
  const FormulaMap map([](model::BedPoint) { return model::BedPoint{}; });
  const Corrector corrector(map, kinematics, firmware(model::ControllerKind::ideal));
  Output output;
  Compensator compensator(
      corrector, {}, [&output](std::string_view bytes) { output.text += bytes; });
  auto source = LineSource::from_text(program);
  const auto summary = compensator.run(source, {});
  if (!summary) output.message = summary.error().message();
  return output;
}

/// Total travel of a program down and up.
double climbed_mm(const std::string& program) {
  auto source = LineSource::from_text(program);
  const auto moves = read_moves(source);
  if (!moves) {
    ADD_FAILURE() << moves.error().message() << "\n" << program;
    return 0.0;
  }
  double sum = 0.0;
  for (const Move& move : *moves) {
    for (int i = 0; i < 200; ++i)
      sum += std::fabs(at(move, (i + 1) / 200.0).z_mm - at(move, i / 200.0).z_mm);
  }
  return sum;
}

/// An arc of G18 or G19 that returns to its initial height has moved in Z.
TEST(Words, UprightArcsKeepTheirHeights) {
  for (const char* arc : {"G18\nG3 I5 K0\n",
                          "G18\nG3 X10 I5 K0\n",
                          "G18\nG2 X10 R5\n",
                          "G18\nG3 X10 R5\n",
                          "G19\nG3 J5 K0\n",
                          "G19\nG2 Y10 J5 K0\n",
                          "G19\nG3 Y10 R5\n"}) {
    SCOPED_TRACE(arc);
    const std::string program = fmt::format("G21 G90\nF900\nG0 X0 Y0 Z5\n{}M30\n", arc);
    const Output output = compensated(program);
    ASSERT_EQ(output.message, "");
    const double climbed = climbed_mm(program);
    EXPECT_GT(climbed, 14.0);  // 5 mm to begin with, and at least 10 on the arc
    // Chords leave out at most the tolerance at each of two turns.
    EXPECT_NEAR(climbed_mm(output.text), climbed, 4.0 * 0.05);
  }
}

TEST(Words, G64KeepsItsToleranceAfterArcs) {
  EXPECT_THAT(words_of("F9\nG0 X0 Y0\nG2 X1 I0.5\nG64 P0.1\nG64 P1 Q0.2\nG1 X3\n"),
              testing::ElementsAre("G64 P0.1", "G64 P1 Q0.2"));
  EXPECT_THAT(words_of("G20 G64 P0.1 Q0.2\n"), testing::ElementsAre("G64 P2.54 Q5.08"));
  // The turns of an arc are not a tolerance, and vice versa.
  EXPECT_EQ(refusal_of("F9 G1 X1\nG64 P2 G2 X10 I2.5\n"),
            "line 2, column 5: the P word could belong to two codes of this line; write each of "
            "them on a line of its own (bad_word_value)");
  EXPECT_THAT(refusal_of("F9 G64 Q1 G83 X1 Z-2 R1\n"), HasSubstr("the Q word could belong to two"));
  EXPECT_THAT(refusal_of("G4 P1 M62\n"), HasSubstr("the P word could belong to two"));
}

TEST(Words, CountsAreWholeNumbers) {
  for (const char* program : {"M98 P7 L2.7\nM2\nO7\nG0 X1\nM99\n",
                              "M98 P7.5\nM2\nO7\nG0 X1\nM99\n",
                              "M61 Q2.5\n",
                              "M61 Q-1\n",
                              "T2.5\n",
                              "G43 H1.5\n",
                              "G43 H-1\n",
                              "M62 P0.5\n",
                              "M67 E1.5 Q1\n",
                              "G10 L2.5 P1 X0\n",
                              "F9 G81 X1 Z-1 R1 L2.5\n"}) {
    EXPECT_THAT(refusal_of(program), HasSubstr("a whole number, not below zero")) << program;
  }
  EXPECT_THAT(refusal_of("o1 repeat [2.7]\no1 endrepeat\n"),
              HasSubstr("a loop is repeated a whole number of times, not 2.7"));
  // An expression may differ from a whole number by rounding.
  EXPECT_THAT(words_of("T[0.1*30]\nG43 H[1/3*6]\n"), testing::ElementsAre("T3", "G43 H2"));
}

/// As grbl's read_float reads: digits, one dot, no exponent; single precision.
bool grbl_reads(std::string_view text, double& value) {
  bool negative = false;
  std::size_t at = 0;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) negative = text[at++] == '-';
  double sum = 0.0;
  double place = 0.0;
  bool digits = false;
  for (; at < text.size(); ++at) {
    if (text[at] == '.' && place == 0.0) {
      place = 1.0;
    } else if (text[at] >= '0' && text[at] <= '9') {
      sum = sum * 10.0 + (text[at] - '0');
      place *= 10.0;
      digits = true;
    } else {
      return false;
    }
  }
  value = (negative ? -sum : sum) / (place == 0.0 ? 1.0 : place);
  return digits;
}

/// Letters and numbers of a line without comments; false where a reader of plain words fails.
bool plain_words(std::string_view line, std::vector<std::pair<char, double>>& words) {
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == ' ') {
      ++at;
      continue;
    }
    const char letter = line[at++];
    std::size_t end = at;
    while (end < line.size() && line[end] != ' ') ++end;
    double value = 0.0;
    if (letter < 'A' || letter > 'Z' || !grbl_reads(line.substr(at, end - at), value)) return false;
    words.emplace_back(letter, value);
    at = end;
  }
  return true;
}

/// Every output is read with the program's values by a reader that accepts only letters and plain
/// decimals.
TEST(Words, AreWrittenAsEveryControllerReadsThem) {
  constexpr std::uint64_t kSeed = 20;
  std::mt19937_64 random(kSeed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 500; ++i) {
    const double size = std::pow(10.0, -9.0 + 15.0 * uniform());
    const double value = i % 3 == 0 ? size : std::round(size * 1e4) / 1e4;
    const auto whole = static_cast<int>(uniform() * 900.0);
    struct Case {
      std::string program;
      char letter;
      double value;
    };
    const std::vector<Case> cases = {
        {with_value("S", value), 'S', value},
        {with_value("G4 P", value), 'P', value},
        {with_value("G64 P", value), 'P', value},
        {with_value("G64 P1 Q", value), 'Q', value},
        {with_value("M67 E1 Q", -value), 'Q', -value},
        {fmt::format("M68 E{} Q1", whole), 'E', static_cast<double>(whole)},
        {fmt::format("M62 P{}", whole), 'P', static_cast<double>(whole)},
        {fmt::format("M61 Q{}", whole), 'Q', static_cast<double>(whole)},
        {fmt::format("G43 H{}", whole), 'H', static_cast<double>(whole)},
        {fmt::format("T{} M6", whole), 'T', static_cast<double>(whole)},
        {with_value("G0 X0 Y0\nG1 X1 F", value + 1e-6), 'F', value + 1e-6},
    };
    for (const Case& one : cases) {
      SCOPED_TRACE(one.program);
      const Output output = compensated(one.program + "\nM2\n");
      ASSERT_EQ(output.message, "");
      bool found = false;
      std::size_t from = 0;
      while (from < output.text.size()) {
        const std::size_t end = output.text.find('\n', from);
        const std::string_view line = std::string_view(output.text).substr(from, end - from);
        from = end + 1;
        if (line.starts_with('(')) continue;
        std::vector<std::pair<char, double>> words;
        ASSERT_TRUE(plain_words(line, words)) << line;
        for (const auto& [letter, read] : words) {
          if (letter != one.letter) continue;
          // F is rounded to six digits, or to three decimals; all other values are unchanged, up to
          // the rounding of this reader's own sum of digits.
          const double tolerance = one.letter == 'F' ? std::min(5.01e-4, 5e-6 * one.value)
                                                     : 1e-12 * std::fabs(one.value);
          found = found || std::fabs(read - one.value) <= tolerance;
        }
      }
      EXPECT_TRUE(found) << output.text;
      EXPECT_NE(refusal_of(output.text).substr(0, 8), "line ") << output.text;
    }
  }
}

TEST(Words, ACircleSmallerThanTheStepHasItsRows) {
  const FormulaMap map([](model::BedPoint) { return model::BedPoint{}; });
  auto source = LineSource::from_text("F100 G0 X0 Y0\nG2 I0.5\nG3 X1 I0.5\n");
  std::vector<PathLengths> rows;
  Findings findings;
  ASSERT_TRUE(path_lengths(
      source, {}, map, {}, 10.0, [&](const PathLengths& row) { rows.push_back(row); }, findings));
  // The rapid's end, eight for the turn, four for half a turn.
  ASSERT_EQ(rows.size(), 13U);
  EXPECT_NEAR(rows[4].place.x_mm, 1.0, 1e-12);  // after half a turn
  EXPECT_NEAR(rows[4].place.y_mm, 0.0, 1e-12);
}

TEST(Words, ToolLengthsPassOnlyWhereTheControllerKnowsThem) {
  const PlainKinematics kinematics;
  const FormulaMap map([](model::BedPoint) { return model::BedPoint{}; });
  for (const auto kind : {model::ControllerKind::ideal,
                          model::ControllerKind::maslow_classic,
                          model::ControllerKind::holey,
                          model::ControllerKind::fluidnc_wallplotter}) {
    const Corrector corrector(map, kinematics, firmware(kind));
    Compensator compensator(corrector, {}, [](std::string_view) {});
    auto source = LineSource::from_text("G0 X1 Y1\nG43 H2\nG0 Z1\n");
    const auto outcome = compensator.run(source, {});
    ASSERT_EQ(outcome.has_value(), kind == model::ControllerKind::ideal);
    if (outcome) continue;
    EXPECT_EQ(outcome.error().place.line, 2U);
    EXPECT_THAT(outcome.error().sentence, HasSubstr("keeps no tool lengths"));
  }
}

}  // namespace
}  // namespace chaintrue::gcode
