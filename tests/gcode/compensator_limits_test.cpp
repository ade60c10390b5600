// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What is not compensated, the number of commands, play, and the real controllers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/gcode/formula_target.hpp"
#include "tests/gcode/program_events.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::gcode {
namespace {

using testing::HasSubstr;

struct Outcome {
  std::string text;
  std::string problem;  ///< name and line of the first one, empty where there is none
  CompensateSummary summary;
  Findings findings;
};

Outcome compensate_within(const std::string& program,
                          const Corrector& corrector,
                          CompensateOptions options = {},
                          const Dialect& dialect = {}) {
  Outcome result;
  Compensator compensator(
      corrector, std::move(options), [&](std::string_view bytes) { result.text += bytes; });
  auto source = LineSource::from_text(program);
  const auto summary = compensator.run(source, dialect);
  result.findings = compensator.findings();
  const auto named = [](const Problem& problem) {
    return fmt::format("{} {}", name(problem.name), problem.place.line);
  };
  if (summary) result.summary = *summary;
  if (!summary) {
    result.problem = named(summary.error());
  } else if (!result.findings.problems.empty()) {
    result.problem = named(result.findings.problems.front());
  }
  return result;
}

VerifySummary verified_within(const std::string& original,
                              const std::string& run,
                              const Corrector& corrector,
                              const VerifyOptions& options = {}) {
  auto a = LineSource::from_text(original);
  auto b = LineSource::from_text(run);
  const auto summary = verify(a, b, corrector, {}, options);
  EXPECT_TRUE(summary) << summary.error().problem.message();
  return summary ? *summary : VerifySummary{};
}

class Limits : public testing::Test {
 protected:
  PlainKinematics kinematics_;
  FormulaMap shift_{[](model::BedPoint) { return model::BedPoint{3.0, -2.0}; }};
  Corrector corrector_{shift_, kinematics_, firmware(model::ControllerKind::maslow_classic)};
};

TEST_F(Limits, AFileThatWasCompensatedIsRefused) {
  const auto once = compensate_within("G0 X10 Y10\nF100 G1 X20\nM2\n", corrector_);
  EXPECT_EQ(once.problem, "");
  const auto twice = compensate_within(once.text, corrector_);
  EXPECT_THAT(twice.problem, HasSubstr("already_compensated"));
}

/// A file without its head, the part of one tool alone, and what senders make of comments.
TEST_F(Limits, AFileIsKnownByMoreThanItsFirstLine) {
  const auto once = compensate_within(
      "G21\nT1 M6\nG0 X10 Y10\nF100 G1 X20\nT2 M6\nG1 X30\nM2\n", corrector_);
  ASSERT_EQ(once.problem, "");
  std::vector<std::string> lines;
  std::istringstream text(once.text);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  // Without as many of its first lines as one likes, down to the last change of the tool.
  std::size_t last_tool = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i] == "T2 M6") last_tool = i;
  ASSERT_GT(last_tool, 0U);
  for (std::size_t first = 1; first <= last_tool; ++first) {
    std::string rest;
    for (std::size_t i = first; i < lines.size(); ++i) rest += lines[i] + "\n";
    EXPECT_THAT(compensate_within(rest, corrector_).problem, HasSubstr("already_compensated"))
        << "without its first " << first << " lines";
  }
  // The end alone, numbered anew, in capitals, and as a comment of the other kind.
  EXPECT_THAT(compensate_within("G0 X1 Y1\n(compensated by chaintrue)\nM2\n", corrector_).problem,
              HasSubstr("already_compensated"));
  EXPECT_THAT(compensate_within("N10 (COMPENSATED  BY CHAINTRUE)\nN20 G0 X1 Y1\n", corrector_).problem,
              HasSubstr("already_compensated"));
  EXPECT_THAT(compensate_within("; compensatedbychaintrue\nG0 X1 Y1\n", corrector_).problem,
              HasSubstr("already_compensated"));
  // A comment that only speaks of it is none.
  EXPECT_EQ(compensate_within("(not yet compensated by chaintrue)\nG0 X1 Y1\n", corrector_).problem,
            "");
}

TEST_F(Limits, TheHeaderSaysWhichSettingsArePresumed) {
  CompensateOptions options;
  options.settings = {"motorspacingx 2978.4", "motoroffsety 463", "rotationradius 139.1",
                      "chainsagcorrection 6.1", "leftchaintolerance 0.12"};
  const auto once = compensate_within("G21 G0 X10 Y10\nM2\n", corrector_, options);
  ASSERT_EQ(once.problem, "");
  std::string settings;
  std::istringstream text(once.text);
  for (std::string line; std::getline(text, line);) {
    EXPECT_LE(line.size(), kMaxOutputLine) << line;
    if (line.starts_with("(settings")) settings += line.substr(9, line.size() - 10);
  }
  EXPECT_EQ(settings,
            " motorspacingx 2978.4 motoroffsety 463 rotationradius 139.1 chainsagcorrection 6.1 "
            "leftchaintolerance 0.12");
}

TEST_F(Limits, WhatCannotBeCutRightIsNamedByLine) {
  const auto problem = [&](const std::string& program, const CompensateOptions& options = {}) {
    return compensate_within(program, corrector_, options).problem;
  };
  EXPECT_EQ(problem("G0 X0 Y0\nG0 X1500 Y0\n"), "outside_map 2");
  EXPECT_EQ(problem("G0 X1 Y1\nG28\n"), "unknown_home 2");
  EXPECT_EQ(problem("F9 G0 X1 Y1 Z5\nG38.2 Z-5\n"), "not_emittable 2");
  EXPECT_EQ(problem("G0 X1 Y1 A5\n"), "unsupported_axis 1");
  CompensateOptions options;
  options.largest_correction_mm = 3.0;  // the correction is 3.61 mm
  EXPECT_EQ(problem("G0 X1 Y1\n", options), "correction_too_large 1");
}

TEST_F(Limits, ASteepCorrectionIsRefused) {
  const FormulaMap steep([](model::BedPoint p) { return model::BedPoint{0.08 * p.x_mm, 0.0}; });
  const Corrector corrector(steep, kinematics_, firmware(model::ControllerKind::ideal));
  EXPECT_EQ(compensate_within("G0 X0 Y0\nG0 X100\n", corrector).problem, "correction_too_steep 2");
}

TEST_F(Limits, TargetsThatTheControllerWouldClampAreAllFound) {
  CompensateOptions options;
  options.clamp_box = ClampBox{1219.2, 609.6};
  const auto outcome = compensate_within(
      "G0 X1217 Y0\nG0 X0 Y-608\nG0 X0 Y0\nG0 X1215 Y-607\n", corrector_, options);
  ASSERT_EQ(outcome.findings.problem_count, 2U);
  EXPECT_EQ(outcome.problem, "outside_controller 1");
  EXPECT_EQ(outcome.findings.problems[1].place.line, 2U);
}

TEST_F(Limits, HomeIsAddedAndTheOutputRunsAtZero) {
  const auto outcome = compensate_within(
      "G21\nG0 X1 Y2\nG91 G0 X1\nG90 F60 G1 X0 Y0\nM2\n", corrector_, {}, {.home_mm = {100.0, -50.0}});
  EXPECT_THAT(outcome.text, HasSubstr("\nG0 X104 Y-50\nG0 X105 Y-50\nG1 X103 Y-52 F60\n"
                                      "(compensated by chaintrue)\nM2\n"));
}

TEST_F(Limits, KeepsWordsCommentsAndFeedsInPlace) {
  const auto outcome = compensate_within(
      "(part)\nG21 S900 M3\nG0 Z5\nG0 X0 Y0\nT2 M6\nG1 Z-1 F90\nG4 P1\nG1 X5 Y0\nG93 X15 "
      "F2\nG94\nG1 X16 F300 ; last\nM5\nM30\n",
      corrector_);
  EXPECT_EQ(outcome.problem, "");
  EXPECT_THAT(outcome.text,
              HasSubstr("G21 G90\n(part)\nS900 M3\nG0 Z5\nG0 X3 Y-2\nT2 M6\n"
                        "(compensated by chaintrue)\nG1 Z-1 F90\nG4 P1\nG1 X8 Y-2\nG1 X18 Y-2 F20\n( last)\n"
                        "G1 X19 Y-2 F300\nM5\n(compensated by chaintrue)\nM30\n"));
}

TEST_F(Limits, NeverTouchesAnAxisThatTheProgramDoesNot) {
  const std::string text = compensate_within("G0 Z5\nM3\nG0 Z6\n", corrector_).text;
  EXPECT_THAT(text, testing::EndsWith("G21 G90\nG0 Z5\nM3\nG0 Z6\n(compensated by chaintrue)\n"));
}

TEST_F(Limits, MovesThatRoundToNothingAreLeftOut) {
  const auto outcome = compensate_within(
      "G0 X1 Y1\nF9 G1 X1.0001\nG1 X1.0002\nG1 X1.0003\nG0 X1.0003\nG1 Y1.001\n", corrector_);
  EXPECT_EQ(outcome.summary.commands, 2U);
}

/// The longest chords on the curve, found by brute force, are hardly fewer.
TEST_F(Limits, TakesHardlyMoreCommandsThanTheToleranceNeeds) {
  const FormulaMap map(random_smooth_displacement(5));
  const Corrector corrector(map, kinematics_, firmware(model::ControllerKind::ideal));
  const double tolerance = 0.05;
  for (const char* program : {"G0 X-1100 Y-500\nF900 G1 X1100 Y500\n",
                              "G0 X400 Y0\nF900 G2 I-400 J0\n",
                              "G0 X20 Y10\nF900 G3 I-15 J0 Z-3\n"}) {
    SCOPED_TRACE(program);
    auto source = LineSource::from_text(program);
    const Move move = read_moves(source)->back();
    const auto command = [&](double t) {
      const Point p = at(move, t);
      const auto c = corrector.command({p.x_mm, p.y_mm});
      return Point{c->x_mm, c->y_mm, p.z_mm};
    };
    const auto fits = [&](double a, double b) {
      const Point from = command(a), to = command(b);
      for (int i = 1; i < 60; ++i) {
        const Point p = command(a + (b - a) * i / 60.0);
        if (distance_mm(p, between(from, to, nearest_on_line(from, to, p))) > tolerance)
          return false;
      }
      return true;
    };
    int least = 0;
    for (double t = 0.0; t < 1.0; ++least) {
      double good = t, step = 1.0 / 4096.0;
      while (good < 1.0 && fits(t, std::min(1.0, good + step))) good = std::min(1.0, good + step);
      ASSERT_GT(good, t);
      t = good;
    }
    const auto outcome = compensate_within(program, corrector);
    EXPECT_LE(static_cast<double>(outcome.summary.commands - 1), 1.5 * least) << "least " << least;
    EXPECT_EQ(verified_within(program, outcome.text, corrector).fault, "");
  }
}

/// Chains that follow the motors only across a gap: with the correction by the path's direction the
/// tool stays on the path.
TEST_F(Limits, PlayIsTakenUpWhereAChainTurnsAround) {
  const FormulaMap map(random_smooth_displacement(6));
  const Corrector corrector(map, kinematics_, firmware(model::ControllerKind::maslow_classic));
  const std::string program =
      "G0 X-200 Y-200\nF600 G1 X200\nG1 Y150\nG3 X-200 Y150 I-200 J0\nG1 X-200 Y-200\nG2 X-200 "
      "Y-200 I100 J0\nG1 X300 Y-150\n";
  VerifyOptions verify_options;
  verify_options.half_play_mm = {0.25, 0.3};
  const auto ignored = compensate_within(program, corrector);
  EXPECT_GT(verified_within(program, ignored.text, corrector, verify_options).largest_mm(), 0.2);
  CompensateOptions options;
  options.half_play_mm = verify_options.half_play_mm;
  const auto corrected = compensate_within(program, corrector, options);
  EXPECT_EQ(corrected.problem, "");
  EXPECT_EQ(verified_within(program, corrected.text, corrector, verify_options).fault, "");
}

}  // namespace
}  // namespace chaintrue::gcode
