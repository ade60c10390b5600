// SPDX-License-Identifier: GPL-3.0-or-later
// Heights in the machine's own frame (G53 with Z alone): passed as they are, and known to verify.
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
  std::string compensated(const std::string& program) const {
    std::string text;
    Compensator compensator(corrector_, {}, [&text](std::string_view bytes) { text += bytes; });
    auto source = LineSource::from_text(program);
    const auto summary = compensator.run(source, {});
    if (!summary) return summary.error().message();
    const Findings& findings = compensator.findings();
    return findings.problems.empty() ? text : findings.problems.front().message();
  }
  bool holds(const std::string& program, const std::string& run) const {
    auto original = LineSource::from_text(program);
    auto other = LineSource::from_text(run);
    const auto summary = verify(original, other, corrector_, {}, {});
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
              HasSubstr("line 5, column 4: after probing or G53 only the machine knows its height"));
  EXPECT_THAT(compensated("G21 G90\nG0 X1 Y1 Z5\nG53 G0 Z-1\nG1 X9 Z-2 F50\nM30\n"),
              HasSubstr("line 4, column 7: after a height in the machine's frame (G53) Z moves by itself first"));
}

TEST(MachineFrameOfMaslow, IsRefusedWhereTheControllerDoesNotKnowIt) {
  const PlainKinematics kinematics;
  const FormulaMap map([](model::BedPoint) { return model::BedPoint{3.0, -2.0}; });
  const Corrector corrector(map, kinematics, firmware(model::ControllerKind::maslow_classic));
  Compensator compensator(corrector, {}, [](std::string_view) {});
  auto source = LineSource::from_text(kRetract);
  const auto summary = compensator.run(source, {});
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().name, ProblemName::not_emittable);
  EXPECT_EQ(summary.error().place.line, 6U);
}

}  // namespace
}  // namespace chaintrue::gcode
