// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The number of commands, and play. What is not compensated: tests/cli/cases/gcode_programs.cases.
#include <gtest/gtest.h>

#include <string>

#include "tests/gcode/compensated_program.hpp"
#include "tests/gcode/formula_target.hpp"
#include "tests/gcode/program_events.hpp"
#include "tools/gcode/simulated_machine.hpp"

namespace chaintrue::gcode {
namespace {

const PlainKinematics kPlain;

TEST(SimulatedMachine, ReadsWordsInTheControllersPrecision) {
  const FormulaMap map(random_smooth_displacement(5));
  const Corrector corrector(map, kPlain, firmware(model::ControllerKind::maslow_classic));
  SimulatedMachine machine(corrector, {});
  Move move;
  move.kind = MoveKind::feed;
  move.to = {0.3335, 9.2352, -0.1};
  move.feed = {FeedMode::per_minute, 500.0};
  Point last;
  machine.run(move, [&](Point /*tool*/, Point command) {
    last = command;
    return true;
  });
  EXPECT_EQ(static_cast<float>(last.x_mm), last.x_mm);
  EXPECT_EQ(static_cast<float>(last.y_mm), last.y_mm);
  EXPECT_EQ(static_cast<float>(last.z_mm), last.z_mm);
}

/// The longest chords on the curve, found by brute force, are hardly fewer.
TEST(Compensator, TakesHardlyMoreCommandsThanTheToleranceNeeds) {
  const FormulaMap map(random_smooth_displacement(5));
  const Corrector corrector(map, kPlain, firmware(model::ControllerKind::ideal));
  const double tolerance = 0.05;
  for (const char* program :
       {"G0 X-1100 Y-500\nF900 G1 X1100 Y500\n", "G0 X400 Y0\nF900 G2 I-400 J0\n",
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
    const auto outcome = compensate(program, corrector).value();
    EXPECT_EQ(outcome.findings.problem_count, 0U);
    EXPECT_LE(static_cast<double>(outcome.summary.commands - 1), 1.5 * least) << "least " << least;
    EXPECT_EQ(verified(program, outcome.text, corrector).fault, "");
  }
}

/// Chains that follow the motors only across a gap: with the correction by the path's direction the
/// tool stays on the path.
TEST(Compensator, TakesUpPlayWhereAChainReverses) {
  const FormulaMap map(random_smooth_displacement(6));
  const Corrector corrector(map, kPlain, firmware(model::ControllerKind::maslow_classic));
  const std::string program =
      "G0 X-200 Y-200\nF600 G1 X200\nG1 Y150\nG3 X-200 Y150 I-200 J0\nG1 X-200 Y-200\nG2 X-200 "
      "Y-200 I100 J0\nG1 X300 Y-150\n";
  VerifyOptions verify_options;
  verify_options.half_play_mm = {0.25, 0.3};
  const auto ignored = compensate(program, corrector).value();
  EXPECT_GT(verified(program, ignored.text, corrector, verify_options).largest_mm(), 0.2);
  CompensateOptions options;
  options.half_play_mm = verify_options.half_play_mm;
  const auto corrected = compensate(program, corrector, options).value();
  EXPECT_EQ(verified(program, corrected.text, corrector, verify_options).fault, "");
}

}  // namespace
}  // namespace chaintrue::gcode
