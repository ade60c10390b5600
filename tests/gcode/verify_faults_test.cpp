// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Faults that verify must detect: every way in which a file can cut something other than the
/// program. And false alarms that it must not raise: cases where the tool is exactly on its path.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/gcode/formula_target.hpp"
#include "tests/gcode/true_machine.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::gcode {
namespace {

using testing::HasSubstr;
using testing_support::TrueMachine;

/// A machine that differs from its controller's kinematics by some millimetres.
struct Bench {
  explicit Bench(model::ControllerKind kind = model::ControllerKind::maslow_classic)
      : map(truth()),
        believed(stated(kind)),
        kinematics(make_controller_kinematics(believed)),
        corrector(map, *kinematics, firmware(kind)) {}

  static model::Machine truth() {
    model::Machine machine;
    machine.motors = {{-1486.0, 1070.0}, {1491.5, 1074.0}};
    return machine;
  }
  static model::Machine stated(model::ControllerKind kind) {
    model::Machine machine;
    machine.controller.kind = kind;
    return machine;
  }
  [[nodiscard]] std::string compensated(const std::string& program, double tolerance_mm) const {
    CompensateOptions options;
    options.tolerance_mm = tolerance_mm;
    options.largest_correction_mm = 100.0;
    std::string text;
    Compensator compensator(corrector, options, [&text](std::string_view b) { text += b; });
    auto source = LineSource::from_text(program);
    const auto outcome = compensator.run(source, {});
    EXPECT_TRUE(outcome) << outcome.error().message();
    EXPECT_EQ(compensator.findings().problem_count, 0U)
        << compensator.findings().problems.front().message();
    return text;
  }
  [[nodiscard]] VerifySummary verified(const std::string& program,
                                       const std::string& run,
                                       double tolerance_mm) const {
    VerifyOptions options;
    options.tolerance_mm = tolerance_mm;
    auto a = LineSource::from_text(program);
    auto b = LineSource::from_text(run);
    const auto summary = verify(a, b, corrector, {}, options);
    EXPECT_TRUE(summary) << summary.error().problem.message();
    return summary ? *summary : VerifySummary{};
  }

  TrueMachine map;
  model::Machine believed;
  std::unique_ptr<const model::ControllerKinematics> kinematics;
  Corrector corrector;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  bool any = false;
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
    any = true;
  }
  EXPECT_TRUE(any) << from << " does not stand in\n" << text;
  return text;
}

/// The first line with this beginning, moved in front of the first one with the other beginning.
std::string moved_line(std::string text, const std::string& line, const std::string& before) {
  const std::size_t at = text.find("\n" + line) + 1;
  const std::size_t end = text.find('\n', at) + 1;
  const std::string taken = text.substr(at, end - at);
  text.erase(at, end - at);
  return text.insert(text.find("\n" + before) + 1, taken);
}

constexpr const char* kPart =
    "G21 G90\nG0 Z5\nG0 X-300 Y-200\nS9000 M3\nG4 P1\nF1000\nG1 Z-3\nG1 X300\nM8\nG1 Y200\nF400\n"
    "G3 X250 Y250 I-50 J0\nG1 X-300\nM9\nG1 Y-200\nG0 Z5\nT2 M6\nG0 X0 Y0\nG1 Z-2\nG2 I40 J0\n"
    "G0 Z5\nM5\nM2\n";

TEST(VerifyFaults, TheCompensatedFileHolds) {
  const Bench bench;
  const auto summary = bench.verified(kPart, bench.compensated(kPart, 0.05), 0.05);
  EXPECT_EQ(summary.fault, "");
  EXPECT_TRUE(summary.holds());
  EXPECT_FALSE(bench.verified(kPart, kPart, 0.05).holds());
}

struct Tampering {
  const char* name;
  std::string (*change)(const std::string&);
  const char* fault;  ///< a part of the message
};
void PrintTo(const Tampering& tampering, std::ostream* out) { *out << tampering.name; }

class Tampered : public testing::TestWithParam<Tampering> {};

TEST_P(Tampered, FilesDoNotHold) {
  const Bench bench;
  const std::string good = bench.compensated(kPart, 0.05);
  const std::string bad = GetParam().change(good);
  ASSERT_NE(good, bad);
  const auto summary = bench.verified(kPart, bad, 0.05);
  EXPECT_FALSE(summary.holds());
  EXPECT_THAT(summary.fault, HasSubstr(GetParam().fault));
}

INSTANTIATE_TEST_SUITE_P(
    Verify,
    Tampered,
    testing::Values(
        Tampering{"every_cut_a_rapid",
                  [](const std::string& good) { return replaced(good, "\nG1 ", "\nG0 "); },
                  "moves at a rapid where"},
        Tampering{"one_cut_a_rapid",
                  [](const std::string& good) {
                    std::string text = good;
                    return text.replace(text.find("\nG1 X"), 4, "\nG0 ");
                  },
                  "moves at a rapid where"},
        Tampering{
            "every_rapid_a_cut",
            [](const std::string& good) { return replaced(good, "\nG0 Z5\nT2", "\nG1 Z5\nT2"); },
            "another motion or feed"},
        Tampering{"feeds_times_100",
                  [](const std::string& good) {
                    return replaced(replaced(good, " F1000", " F100000"), " F400", " F40000");
                  },
                  "moves at F100000 where"},
        Tampering{"feed_9_for_1000",
                  [](const std::string& good) { return replaced(good, " F1000", " F9"); },
                  "moves at F9 where"},
        Tampering{"feed_one_tenth_up",
                  [](const std::string& good) { return replaced(good, " F400", " F440"); },
                  "another motion or feed"},
        Tampering{"spindle_off_before_the_cut",
                  [](const std::string& good) { return moved_line(good, "M5", "G1 Z-3"); },
                  "M5 on line"},
        Tampering{"spindle_on_after_the_plunge",
                  [](const std::string& good) { return moved_line(good, "S9000 M3", "M8"); },
                  "has G4 P1 where line 4 of the original has S9000"},
        Tampering{"coolant_a_corner_late",
                  [](const std::string& good) { return moved_line(good, "M8", "M9"); },
                  "M8 of line 9 of the original does not come at its place"},
        Tampering{"tool_change_left_out",
                  [](const std::string& good) { return replaced(good, "T2 M6\n", ""); },
                  "T2 of line 17 of the original does not come"},
        Tampering{"another_tool",
                  [](const std::string& good) { return replaced(good, "T2 M6", "T3 M6"); },
                  "has T3 where line 17 of the original has T2"},
        Tampering{"another_speed",
                  [](const std::string& good) { return replaced(good, "S9000", "S900"); },
                  "has S900 where"},
        Tampering{"a_shorter_dwell",
                  [](const std::string& good) { return replaced(good, "G4 P1", "G4 P0.1"); },
                  "has G4 P0.1 where"},
        Tampering{"another_end",
                  [](const std::string& good) { return replaced(good, "\nM2\n", "\nM30\n"); },
                  "has M30 where"},
        Tampering{"too_deep",
                  [](const std::string& good) { return replaced(good, " Z-3", " Z-3.1"); },
                  "moves the tool to"},
        Tampering{"a_move_twice",
                  [](const std::string& good) {
                    const std::size_t at = good.find("\nM9\n");
                    const std::size_t line = good.rfind("\nG1 ", at - 1);
                    const std::size_t other = good.rfind("\nG1 ", line - 1);
                    // Forwards, half back, and forwards again: every point is on the path.
                    std::string text = good;
                    return text.insert(
                        at, good.substr(other, line - other) + good.substr(line, at - line));
                  },
                  "M9 of line 14 of the original does not come at its place"},
        Tampering{"cut_short",
                  [](const std::string& good) {
                    const std::size_t at = good.find("\nG0 Z5\nM5");
                    const std::size_t line = good.rfind("\nG1 ", at - 1);
                    std::string text = good;
                    return text.erase(line, at - line);
                  },
                  "away from line 20 of the original"}),
    [](const auto& tampering) { return std::string(tampering.param.name); });

/// If the tool is exactly on its path there is no fault, however small the path.
TEST(VerifyFaults, SmallCirclesAndShortMovesAreNoFaults) {
  for (const char* program :
       {"F900\nG3 I0.334009898 J-0.372071751\nG1X87.490 Y 59.138 Z0.00000\n",
        "F900 G0 X10 Y10\nG2 I0.25 J0\nG1 X60 Y40\nG3 I0.01 J0 P7\nG1 X60.002\nG1 X60\n",
        "F900 G0 X10 Y10\nG1 X10.001\nG1 X10\nG1 X10.001\nG1 X10\nG1 X10.001\nM3\nG1 X10\nG0 "
        "Z1\n"}) {
    for (const auto kind : {model::ControllerKind::ideal,
                            model::ControllerKind::maslow_classic,
                            model::ControllerKind::holey,
                            model::ControllerKind::fluidnc_wallplotter}) {
      const Bench bench(kind);
      for (const double tolerance_mm : {0.005, 0.02, 0.05, 0.2, 1.0}) {
        SCOPED_TRACE(fmt::format("{} {} mm\n{}", firmware(kind).name, tolerance_mm, program));
        const std::string run = bench.compensated(program, tolerance_mm);
        EXPECT_EQ(bench.verified(program, run, tolerance_mm).fault, "") << run;
      }
    }
  }
}

/// A long sequence of moves that round to zero, all within the tolerance, does not fill the memory
/// and is no fault.
TEST(VerifyFaults, AnEndlessTrembleIsNoFault) {
  std::string program = "F900 G0 X10 Y10\n";
  for (int i = 0; i < 5000; ++i) program += i % 2 == 0 ? "G1 X10.0102\n" : "G1 X10\n";
  program += "G1 X40\n";
  const Bench bench;
  EXPECT_EQ(bench.verified(program, bench.compensated(program, 0.05), 0.05).fault, "");
}

/// A wave of the correction narrower than the sampling of compensate: the file is wrong, and the
/// error is detected.
TEST(VerifyFaults, WhatCompensateMissedIsSeen) {
  const FormulaMap map([](model::BedPoint p) {
    const double x = (p.x_mm - 112.0) / 10.0, y = p.y_mm / 10.0;
    return model::BedPoint{0.0, 0.4 * std::exp(-x * x - y * y)};
  });
  const PlainKinematics kinematics;
  const Corrector corrector(map, kinematics, firmware(model::ControllerKind::ideal));
  const std::string program = "F900 G0 X0 Y0\nG1 X200\n";
  std::string run;
  Compensator compensator(corrector, {}, [&run](std::string_view bytes) { run += bytes; });
  auto source = LineSource::from_text(program);
  ASSERT_TRUE(compensator.run(source, {}));
  ASSERT_THAT(run, HasSubstr("\nG1 X200 Y0 F900\n")) << "the wave was found; make it narrower";
  auto a = LineSource::from_text(program);
  auto b = LineSource::from_text(run);
  const auto summary = verify(a, b, corrector, {}, {});
  ASSERT_TRUE(summary);
  EXPECT_FALSE(summary->holds());
  EXPECT_GT(summary->largest_mm(), 0.3);
}

}  // namespace
}  // namespace chaintrue::gcode
