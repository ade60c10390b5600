// SPDX-License-Identifier: GPL-3.0-or-later
// A real machine, scanned twice a day apart: the named causes are the same whichever line is left
// out, one scan predicts the other, and an effect added to the real residuals is found
// (docs/diagnosis_rates.md).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <optional>
#include <set>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/observation/length_points.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kPitchMm = 76.2;
constexpr const char* kFull = "C_2018-09-30_full.csv";
constexpr const char* kUpper = "D_2018-10-01_upper_half.csv";

int line(double coordinate_mm) { return static_cast<int>(std::lround(coordinate_mm / kPitchMm)); }

class RealScans : public testing::Test {
 protected:
  void SetUp() override {
    data_ = std::filesystem::path(CHAINTRUE_SHARED_DATA);
    if (!std::filesystem::exists(data_ / "optical_grid" / kFull)) {
      GTEST_SKIP() << "the scans are not part of a checkout and are not here: "
                   << data_ / "optical_grid";
    }
  }

  MeasuredGrid scan(const char* file, std::optional<VisitingOrder> assumed = {}) const {
    files::OpticalOptions options;
    options.order = assumed;
    // The settings in force were not recorded, so the tolerances' purpose is unknown.
    options.machine =
        files::read(files::parse_groundcontrol, data_ / "holey" / "groundcontrol_2018-09-01b.ini",
                    files::Tolerances::unexplained)
            .machine;
    options.pitch_mm = kPitchMm;
    MeasuredGrid grid = files::read(files::parse_optical, data_ / "optical_grid" / file, options);
    grid.noise = StatedNoise{0.1, 0.3, 12.0};
    return grid;
  }

  static Diagnosis diagnosed(const MeasuredGrid& grid) {
    DiagnosisOptions options;
    options.improvement = false;
    options.next_measurements = false;
    return diagnose(grid, options).value();
  }

  static std::set<std::string> names(const Diagnosis& d) {
    std::set<std::string> result;
    for (const Cause& c : d.causes) {
      result.insert(fmt::format("{}:{}", c.cause.effect->id, model::effects::name(c.cause.side)));
    }
    return result;
  }

  std::filesystem::path data_;
};

TEST_F(RealScans, BothScansNameTheBannersScale) {
  for (const char* file : {kUpper, kFull}) {
    // With the whole bed's marks play is detected, but only with an assumed order; without it
    // nothing is named.
    const Diagnosis d = diagnosed(scan(file, VisitingOrder{.rows = false, .serpentine = true}));
    EXPECT_TRUE(names(d).contains("tape_scale:x")) << file << ": " << d.sentence;
    EXPECT_TRUE(std::ranges::none_of(d.extended_machine.effects, [](const auto& e) {
      return e.effect == "tape_scale";
    })) << "the banner's scale is none of the machine's";
  }
}

TEST_F(RealScans, NamesHoldWithoutAnyLine) {
  const MeasuredGrid whole = scan(kUpper);
  for (const bool columns : {true, false}) {
    std::set<int> lines;
    const auto of = [&](const MeasuredPoint& p) {
      return line(columns ? p.mark.x_mm : p.mark.y_mm);
    };
    for (const MeasuredPoint& p : whole.points) lines.insert(of(p));
    for (const int left_out : lines) {
      MeasuredGrid grid = whole;
      std::erase_if(grid.points, [&](const MeasuredPoint& p) { return of(p) == left_out; });
      const Diagnosis d = diagnosed(grid);
      EXPECT_TRUE(names(d).contains("tape_scale:x"))
          << (columns ? "column " : "row ") << left_out << ": " << d.sentence;
    }
  }
}

TEST_F(RealScans, OneScanPredictsTheOther) {
  // The later scan, of the upper half, and the earlier one's marks there.
  const MeasuredGrid first = scan(kUpper);
  MeasuredGrid second = scan(kFull);
  std::erase_if(second.points, [](const MeasuredPoint& p) { return p.mark.y_mm < -1.0; });
  const Diagnosis d = diagnosed(first);
  const auto given_cause = transfer(first, d, second);
  ASSERT_TRUE(given_cause);
  // A day apart: a pattern of the machine or of the banner is in both scans.
  EXPECT_LT(given_cause->extended.rms_mm, 0.6 * given_cause->calibrated.rms_mm);
  EXPECT_LT(given_cause->extended_and_surface.rms_mm, given_cause->extended.rms_mm);
}

TEST_F(RealScans, APlantedEffectIsFound) {
  // Without a noise model: the scan's own residuals, plus a left sprocket with an eccentricity of
  // 0.4 mm.
  constexpr double kAmplitudeMm = 0.4;
  constexpr double kSprocketTurnMm = 63.5;
  MeasuredGrid grid = scan(kUpper);
  const auto lengths = length_points(grid);
  ASSERT_TRUE(lengths);
  const auto is_planted = [](const Cause& c) {
    return c.cause.effect->id == "sprocket_eccentricity" &&
           c.cause.side == model::effects::EffectSide::left;
  };
  const Diagnosis before = diagnosed(grid);
  EXPECT_TRUE(std::ranges::none_of(before.causes, is_planted)) << before.sentence;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const double length = (*lengths)[i].lengths.left_mm;
    grid.points[i].lengths = (*lengths)[i].lengths;
    grid.points[i].lengths->left_mm +=
        kAmplitudeMm * std::sin(2.0 * std::numbers::pi * length / kSprocketTurnMm + 1.0);
    grid.points[i].commanded.reset();
  }
  const Diagnosis after = diagnosed(grid);
  SCOPED_TRACE(after.sentence);
  const auto found = std::ranges::find_if(after.causes, is_planted);
  ASSERT_NE(found, after.causes.end());
  const ParameterEstimate& size = found->parameters.front();
  // The real sprocket's own eccentricity is included: below 0.1 mm by the bound above.
  EXPECT_NEAR(size.value, kAmplitudeMm, 4.0 * size.sigma + 0.1);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
