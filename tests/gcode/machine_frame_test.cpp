// SPDX-License-Identifier: GPL-3.0-or-later
// Motions in the machine's own frame. Heights (G53, G28, G30 with Z alone) pass as they are and are known
// to verify; places in X and Y are refused, or are where a plotter's controller is after homing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/gcode/formula_target.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::gcode {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A cut that retracts to 1 mm below the homing switch, as CAM programs for grbl do.
constexpr const char* kRetract =
    "G21 G90 G54\nG0 Z5\nG0 X100 Y100\nG1 Z-3 F300\nG1 X150 F900\nG53 G0 Z-1\nG0 X0 Y0\nG0 Z5\nM30\n";

class MachineFrame : public testing::TestWithParam<model::ControllerKind> {
 protected:
  /// The output, or the first problem.
  std::string compensated(const std::string& program, const Dialect& dialect = {}) const {
    std::string text;
    Compensator compensator(corrector_, {}, [&text](std::string_view bytes) { text += bytes; });
    auto source = LineSource::from_text(program);
    const auto summary = compensator.run(source, dialect);
    if (!summary) return summary.error().message();
    const Findings& findings = compensator.findings();
    return findings.problems.empty() ? text : findings.problems.front().message();
  }
  bool holds(const std::string& program, const std::string& run, const Dialect& dialect = {}) const {
    auto original = LineSource::from_text(program);
    auto other = LineSource::from_text(run);
    const auto summary = verify(original, other, corrector_, dialect, {});
    EXPECT_TRUE(summary) << summary.error().problem.message();
    return summary && summary->holds();
  }

  PlainKinematics kinematics_;
  FormulaMap shift_{[](model::BedPoint) { return model::BedPoint{3.0, -2.0}; }};
  Corrector corrector_{shift_, kinematics_, firmware(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(ThatKnowsG53,
                         MachineFrame,
                         testing::Values(model::ControllerKind::fluidnc_wallplotter,
                                         model::ControllerKind::ideal),
                         [](const auto& tested) { return tested.param == model::ControllerKind::ideal ? "Ideal" : "FluidNc"; });

TEST_P(MachineFrame, AHeightStaysInIt) {
  const std::string text = compensated(kRetract);
  EXPECT_THAT(text, HasSubstr("\nG53 G0 Z-1\n"));
  EXPECT_THAT(text, Not(HasSubstr("\nG0 Z-1\n")));
  EXPECT_TRUE(holds(kRetract, text));
}

TEST_P(MachineFrame, TheNextHeightOfTheWorkIsWrittenWhateverItWas) {
  const std::string text =
      compensated("G21 G90\nG0 X1 Y1 Z5\nG53 G0 Z-1\nG0 Z5\nG1 Z4 F50\nG53 G1 Z-1 F70\nG1 Z4\nM30\n");
  EXPECT_THAT(text, HasSubstr("\nG53 G0 Z-1\nG0 Z5\n"));
  EXPECT_THAT(text, HasSubstr("\nG53 G1 Z-1 F70\nG1 Z4 F70\n"));
}

TEST_P(MachineFrame, InInchesIsWrittenInMillimetres) {
  EXPECT_THAT(compensated("G20 G90\nG0 X1 Y1 Z1\nG53 G0 Z-0.5\nM30\n"), HasSubstr("\nG53 G0 Z-12.7\n"));
}

TEST_P(MachineFrame, VerifyRefusesAHeightThatBecameOneOfTheWork) {
  std::string plunge = compensated(kRetract);
  const std::string raise = "G53 G0 Z-1";
  plunge.replace(plunge.find(raise), raise.size(), "G0 Z-1");
  EXPECT_FALSE(holds(kRetract, plunge));
  std::string raised = compensated("G21 G90\nG0 Z5\nG0 X1 Y1\nG0 Z2\nM30\n");
  const std::string lower = "G0 Z2";
  raised.replace(raised.find(lower), lower.size(), "G53 G0 Z2");
  EXPECT_FALSE(holds("G21 G90\nG0 Z5\nG0 X1 Y1\nG0 Z2\nM30\n", raised));
}

TEST_P(MachineFrame, NothingStartsAtAHeightThatOnlyTheMachineKnows) {
  EXPECT_THAT(compensated("G21 G90\nG0 X1 Y1 Z5\nG53 G0 Z-1\nG91\nG0 Z-2\nM30\n"),
              HasSubstr("line 5, column 4: after probing, G53, G28 or G30 only the machine knows its height"));
  EXPECT_THAT(compensated("G21 G90\nG0 X1 Y1 Z5\nG53 G0 Z-1\nG1 X9 Z-2 F50\nM30\n"),
              HasSubstr("line 4, column 7: after a height in the machine's frame (G53, G28, G30) Z moves by itself first"));
}

/// Ways to raise the tool in the machine's frame, and the lines that are written for them.
struct Retract {
  const char* line;
  const char* written;
};
constexpr Retract kRetracts[] = {
    {"G53 G0 Z-1", "\nG53 G0 Z-1\n"},
    {"G28 G91 Z0\nG90", "\nG91\nG28 Z0\nG90\n"},
    {"G91 G28 Z2\nG90", "\nG91\nG28 Z2\nG90\n"},
    {"G28 Z5", "\nG28 Z5\n"},
    {"G30 G91 Z0\nG90", "\nG91\nG30 Z0\nG90\n"},
};

std::string with_retract(const std::string& retract) {
  return "G21 G90 G54\nG0 Z5\nG0 X100 Y100\nG1 Z-3 F300\nG1 X150 F900\n" + retract +
         "\nG0 Y120\nG0 Z5\nG1 Z-3\nG1 X100\nM30\n";
}

TEST_P(MachineFrame, EveryRetractPassesAndLeavesXAndYKnown) {
  for (const Retract& retract : kRetracts) {
    SCOPED_TRACE(retract.line);
    const std::string program = with_retract(retract.line);
    const std::string text = compensated(program);
    EXPECT_THAT(text, HasSubstr(retract.written));
    // Y alone is named: X is where the cut ended, and both are written, moved by the map's 3 and -2.
    EXPECT_THAT(text, HasSubstr("\nG0 X153 Y118\nG0 Z5\n"));
    EXPECT_TRUE(holds(program, text));
  }
}

TEST_P(MachineFrame, VerifyKnowsEveryRetractFromAHeightOfTheWork) {
  for (const Retract& retract : kRetracts) {
    SCOPED_TRACE(retract.line);
    const std::string program = with_retract(retract.line);
    std::string plunge = compensated(program);
    plunge.replace(plunge.find(retract.written), std::string(retract.written).size(), "\nG0 Z-1\n");
    EXPECT_FALSE(holds(program, plunge));
  }
}

TEST_P(MachineFrame, AHeightByWayOfAPointIsOneOfTheOutputsFrame) {
  EXPECT_THAT(compensated("G20 G90\nG0 X1 Y1 Z1\nG92 Z0.5\nG28 Z0.25\nM30\n"),
              HasSubstr("\nG28 Z19.05\n"));
}

TEST_P(MachineFrame, PlacesInXAndYAreRefusedWithAWayOut) {
  for (const char* line : {"G53 G0 X0 Y0", "G53 G0 X10 Z-1", "G53 G1 Y5 F100", "G28", "G30",
                           "G28 G91 X0 Y0", "G28 X0 Y0 Z0", "G30 X1"}) {
    SCOPED_TRACE(line);
    const std::string text = compensated("G21 G90\nG0 X1 Y1 Z5\n" + std::string(line) + "\nM30\n");
    EXPECT_THAT(text, HasSubstr("line 3: "));
    EXPECT_THAT(text, HasSubstr("write the place on the sheet"));
    EXPECT_THAT(text, HasSubstr("(unknown_home)"));
  }
}

TEST_P(MachineFrame, AHomeThatIsStatedIsOneOfTheSheet) {
  const std::string stored = "G21 G90\nG0 X30 Y40 Z5\nG28.1\nG0 X1\nG28 X7 Y8\nM30\n";
  EXPECT_THAT(compensated(stored), HasSubstr("\nG0 X10 Y6\nG0 X33 Y38\n"));
  Dialect dialect;
  dialect.home_is_zero = true;
  EXPECT_THAT(compensated("G21 G90\nG0 X30 Y40 Z5\nG28\nM30\n", dialect), HasSubstr("\nG0 X3 Y-2 Z0\n"));
}

TEST_P(MachineFrame, APlottersHomeIsWhereItsControllerIsAfterHoming) {
  Dialect dialect;
  dialect.passes_plotter_codes = true;
  dialect.plotter_home_mm = {50.0, -60.0};
  const std::string program =
      "G21\nG90\nG28 X Y\nG0 X10 Y20\nG1 X30 F900\nG28\nG1 X40 Y-50\nM300 P10\nG91\nG1 X1\n";
  const std::string text = compensated(program, dialect);
  EXPECT_THAT(text, HasSubstr("\nG28 X Y\nG0 X13 Y18\n"));
  EXPECT_THAT(text, HasSubstr("\nG28\nG1 X43 Y-52 F900\nM300 P10\nG1 X44 Y-52\n"));
  EXPECT_TRUE(holds(program, text, dialect));
  std::string other = text;
  const std::string cut = "X43 Y-52";
  other.replace(other.find(cut), cut.size(), "X44 Y-52");
  EXPECT_FALSE(holds(program, other, dialect));
}

TEST(MachineFrameOfMaslow, IsRefusedWhereTheControllerDoesNotKnowIt) {
  const PlainKinematics kinematics;
  const FormulaMap map([](model::BedPoint) { return model::BedPoint{3.0, -2.0}; });
  const Corrector corrector(map, kinematics, firmware(model::ControllerKind::maslow_classic));
  for (const Retract& retract : kRetracts) {
    SCOPED_TRACE(retract.line);
    Compensator compensator(corrector, {}, [](std::string_view) {});
    auto source = LineSource::from_text(with_retract(retract.line));
    const auto summary = compensator.run(source, {});
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().name, ProblemName::not_emittable);
    EXPECT_EQ(summary.error().place.line, 6U);
  }
}

}  // namespace
}  // namespace chaintrue::gcode
