// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Words that are passed through: which code they belong to, and which are whole numbers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/gcode/formula_target.hpp"
#include "tests/gcode/program_events.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/reports.hpp"

namespace chaintrue::gcode {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  ProgramEvents events;
  const auto outcome = run_text(text, events);
  EXPECT_TRUE(outcome) << text << ": " << outcome.error().message();
  std::vector<std::string> words;
  for (const PassedWord& word : events.words) words.push_back(word.text);
  return words;
}

/// Name and line of the refusal: `bad_word_value 2`.
std::string refusal_of(const std::string& text) {
  ProgramEvents events;
  const auto outcome = run_text(text, events);
  if (outcome) return "accepted";
  return fmt::format("{} {}", name(outcome.error().name), outcome.error().place.line);
}

TEST(Words, G64KeepsItsToleranceAfterArcs) {
  EXPECT_THAT(words_of("F9\nG0 X0 Y0\nG2 X1 I0.5\nG64 P0.1\nG64 P1 Q0.2\nG1 X3\n"),
              testing::ElementsAre("G64 P0.1", "G64 P1 Q0.2"));
  EXPECT_THAT(words_of("G20 G64 P0.1 Q0.2\n"), testing::ElementsAre("G64 P2.54 Q5.08"));
  // The turns of an arc are not a tolerance, and vice versa.
  EXPECT_EQ(refusal_of("F9 G1 X1\nG64 P2 G2 X10 I2.5\n"),
            "bad_word_value 2");
  EXPECT_EQ(refusal_of("F9 G64 Q1 G83 X1 Z-2 R1\n"), "bad_word_value 1");
  EXPECT_EQ(refusal_of("G4 P1 M62\n"), "bad_word_value 1");
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
    EXPECT_EQ(refusal_of(program), "bad_word_value 1") << program;
  }
  EXPECT_EQ(refusal_of("o1 repeat [2.7]\no1 endrepeat\n"), "bad_flow 1");
  // An expression may differ from a whole number by rounding.
  EXPECT_THAT(words_of("T[0.1*30]\nG43 H[1/3*6]\n"), testing::ElementsAre("T3", "G43 H2"));
}

TEST(Words, ACircleSmallerThanTheStepHasItsRows) {
  const FormulaMap map([](model::BedPoint) { return model::BedPoint{}; });
  auto source = LineSource::from_text("F100 G0 X0 Y0\nG2 I0.5\nG3 X1 I0.5\n");
  std::vector<PathLengths> rows;
  Findings findings;
  ASSERT_TRUE(path_lengths(
      source, {}, map, 10.0, [&](const PathLengths& row) { rows.push_back(row); }, findings));
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
    EXPECT_EQ(outcome.error().name, ProblemName::not_emittable);
    EXPECT_EQ(outcome.error().place.line, 2U);
  }
}

}  // namespace
}  // namespace chaintrue::gcode
