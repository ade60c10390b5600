// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compensated files, run on a simulated controller and machine, follow the intended path;
/// uncompensated ones do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/gcode/compensated_program.hpp"
#include "tests/gcode/corpus.hpp"
#include "tests/gcode/formula_target.hpp"
#include "tests/gcode/program_events.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::gcode {
namespace {

using testing_support::kCorpus;
using testing_support::test_name;

constexpr double kToleranceMm = 0.05;

/// Real files that LinuxCNC or this program refuses, that do not fit the bed, or that the output
/// language cannot express; by name, since otherwise every test of this program would read all of
/// them first.
constexpr std::array<std::string_view, 16> kOthers = {
    "fluidnc_gcode_conditionals_test.nc",
    "fluidnc_parsetest.nc",
    "fluidnc_probe.nc",
    "gpr_cura_3D_printer.gcode",
    "gpr_mazak_sample.EIA",
    "klipper_sdcard_loop_big.gcode",
    "linuxcnc_bad_arc_small_imperial.ngc",
    "linuxcnc_bad_no_feed.ngc",
    "linuxcnc_bad_no_ijr.ngc",
    "linuxcnc_boat-xyzbc.ngc",
    "linuxcnc_good_arc_big_metric.ngc",
    "linuxcnc_nurbs-xy.ngc",
    "linuxcnc_test_rotation_g53.ngc",
    "linuxcnc_test_unit_conversion.ngc",
    "makerverse_circle_diamond_square.gcode",
    "makerverse_full_circle_without_xyz.gcode",
};

bool is_other(std::string_view name) {
  return std::find(kOthers.begin(), kOthers.end(), name) != kOthers.end();
}

std::vector<std::string> programs() {
  std::vector<std::string> names;
  if (!std::filesystem::exists(kCorpus)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(kCorpus)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".canon") || name == "README.md" || name == "index.tsv" ||
        name == "hazard_oracle.md")
      continue;
    names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> fitting_files() {
  std::vector<std::string> names = programs();
  std::erase_if(names, is_other);
  return names;
}

TEST(RealFiles, FitTheBed) {
  if (!std::filesystem::exists(kCorpus)) GTEST_SKIP() << "no real G-code files at " << kCorpus;
  Dialect dialect;
  dialect.tools_have_no_diameter = true;
  for (const std::string& name : programs()) {
    auto source = LineSource::from_file((kCorpus / name).string());
    ASSERT_TRUE(source) << name;
    const auto moves = read_moves(*source, dialect);
    const bool fits =
        moves && !moves->empty() && std::all_of(moves->begin(), moves->end(), [](const Move& move) {
          const auto turns = [](double degrees) { return degrees != 0.0; };
          return std::fabs(move.to.x_mm) <= 1219.2 && std::fabs(move.to.y_mm) <= 609.6 &&
                 move.kind != MoveKind::probe &&
                 std::none_of(move.turn_deg.begin(), move.turn_deg.end(), turns);
        });
    EXPECT_EQ(fits, !is_other(name)) << name;
  }
}

class RealFile : public testing::TestWithParam<std::string> {
 protected:
  RealFile() { dialect_.tools_have_no_diameter = true; }
  Dialect dialect_;
  PlainKinematics kinematics_;
};

TEST_P(RealFile, IsCutWithinTheToleranceAndNotWithoutCompensation) {
  const std::string original = testing_support::read_text(kCorpus / GetParam());
  for (const NamedDisplacement& named : displacements()) {
    SCOPED_TRACE(named.name);
    const FormulaMap map(named.displacement);
    // Only the ideal controller implements tool lengths.
    const bool lengths = original.find("G43") != std::string::npos;
    const Corrector corrector(
        map, kinematics_,
        firmware(lengths ? model::ControllerKind::ideal : model::ControllerKind::maslow_classic));
    const auto output = compensate(original, corrector, {}, dialect_);
    ASSERT_TRUE(output) << output.error().message();
    ASSERT_EQ(output->findings.problem_count, 0U) << output->findings.problems.front().message();
    VerifyOptions options;
    const auto summary = verified(original, output->text, corrector, options, dialect_);
    EXPECT_EQ(summary.fault, "");
    EXPECT_TRUE(summary.holds());
    EXPECT_LE(summary.largest_mm(), kToleranceMm)
        << "line " << summary.feeds.original_line << " / " << summary.rapids.original_line;
    EXPECT_GT(summary.places, 0U);
    const auto control = verified(original, original, corrector, options, dialect_);
    EXPECT_FALSE(control.holds());
  }
}

TEST_P(RealFile, IdentityKeepsIt) {
  const std::string original = testing_support::read_text(kCorpus / GetParam());
  const FormulaMap map([](model::BedPoint) { return model::BedPoint{}; });
  const Corrector corrector(map, kinematics_, firmware(model::ControllerKind::ideal));
  CompensateOptions options;
  options.tolerance_mm = 0.005;
  options.decimals = 4;
  const auto output = compensate(original, corrector, options, dialect_);
  ASSERT_TRUE(output) << output.error().message();
  auto before = LineSource::from_text(original);
  auto after = LineSource::from_text(output->text);
  const auto intended = read_moves(before, dialect_);
  const auto written = read_moves(after);
  ASSERT_TRUE(intended && written);
  // Every end of a straight move of the original is the end of one of the output, to rounding, in
  // order.
  std::size_t at_output = 0;
  for (const Move& move : *intended) {
    if (move.arc || !move.names_xy || distance_mm(move.from, move.to) < 2e-4) continue;
    const auto same = [&](const Move& other) {
      // Half a unit of the fourth decimal in each of three axes, and the sum's rounding.
      return distance_mm(other.to, move.to) < 0.5e-4 * 1.7321 + 1e-9;
    };
    const auto found = std::find_if(written->begin() + static_cast<std::ptrdiff_t>(at_output),
                                    written->end(), same);
    ASSERT_NE(found, written->end()) << "the end of line " << move.line << " is missing";
    at_output = static_cast<std::size_t>(found - written->begin());
  }
  VerifyOptions verify_options;
  verify_options.tolerance_mm = options.tolerance_mm;
  verify_options.decimals = options.decimals;
  EXPECT_EQ(verified(original, output->text, corrector, verify_options, dialect_).fault, "");
}

INSTANTIATE_TEST_SUITE_P(Corpus, RealFile, testing::ValuesIn(fitting_files()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealFile);

}  // namespace
}  // namespace chaintrue::gcode
