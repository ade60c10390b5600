// SPDX-License-Identifier: GPL-3.0-or-later
// A real machine, scanned twice a day apart: the names stand whatever line is left out, one scan
// foretells the other, and an effect planted on the real residuals is found. The scans stay in
// ../shared/data; every second line of them is enough here. What all their points say is in
// docs/diagnosis.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/map/length_points.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kPitchMm = 76.2;
constexpr const char* kFull = "C_2018-09-30_full.csv";
constexpr const char* kUpper = "D_2018-10-01_upper_half.csv";

int line(double coordinate_mm) { return static_cast<int>(std::lround(coordinate_mm / kPitchMm)); }

/// A scan, every second line of it, visited by assumption as its README has it.
class RealScans : public testing::Test {
 protected:
  void SetUp() override {
    data_ = std::filesystem::path(CHAINTRUE_SHARED_DATA);
    if (!std::filesystem::exists(data_ / "optical_grid" / kFull)) {
      GTEST_SKIP() << "the scans are not beside this checkout: " << data_ / "optical_grid";
    }
  }

  [[nodiscard]] MeasuredGrid scan(const char* file) const {
    files::OpticalOptions options;
    options.machine =
        files::read_groundcontrol(data_ / "holey" / "groundcontrol_2018-09-01b.ini").machine;
    options.pitch_mm = kPitchMm;
    MeasuredGrid grid = files::read_optical(data_ / "optical_grid" / file, options).grid;
    std::erase_if(grid.points, [](const MeasuredPoint& p) {
      return line(p.mark.x_mm) % 2 == 0 || line(p.mark.y_mm) % 2 == 0;
    });
    grid.noise = StatedNoise{0.1, 0.3, 12.0};
    return grid;
  }

  static Diagnosis diagnosed(const MeasuredGrid& grid) {
    DiagnosisOptions options;
    options.gain = false;
    options.next_measurements = false;
    const auto answer = diagnose(grid, options);
    EXPECT_TRUE(answer);
    return *answer;
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
  for (const char* file : {kFull, kUpper}) {
    const Diagnosis d = diagnosed(scan(file));
    EXPECT_TRUE(names(d).contains("tape_scale:x")) << file << ": " << d.sentence;
    EXPECT_TRUE(std::none_of(d.extended_machine.effects.begin(),
                             d.extended_machine.effects.end(),
                             [](const auto& e) { return e.effect == "tape_scale"; }))
        << "the banner's scale is none of the machine's";
  }
}

TEST_F(RealScans, NamesStandWithoutAnyLine) {
  const MeasuredGrid whole = scan(kUpper);
  const Diagnosis all = diagnosed(whole);
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

TEST_F(RealScans, OneScanForetellsTheOther) {
  const MeasuredGrid first = scan(kFull);
  const MeasuredGrid second = scan(kUpper);
  const Diagnosis d = diagnosed(first);
  const auto told = transfer(first, d, second);
  ASSERT_TRUE(told);
  fmt::print(
      "foretold: {:.2f} mm as stated, {:.2f} calibrated, {:.2f} with the causes, {:.2f} with "
      "the surface\n",
      told->as_delivered.rms_mm,
      told->calibrated.rms_mm,
      told->extended.rms_mm,
      told->extended_and_surface.rms_mm);
  // A day apart: a pattern of the machine or of the banner shows in both.
  EXPECT_LT(told->extended.rms_mm, 0.4 * told->calibrated.rms_mm);
  EXPECT_LT(told->extended_and_surface.rms_mm, told->extended.rms_mm);
}

TEST_F(RealScans, APlantedEffectIsFound) {
  // No model of the noise: the scan's own residuals, and a pitch error of the left chain on top.
  constexpr double kElongation = 0.002;
  MeasuredGrid grid = scan(kUpper);
  const auto lengths = length_points(grid);
  ASSERT_TRUE(lengths);
  const Diagnosis before = diagnosed(grid);
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    grid.points[i].lengths = (*lengths)[i].lengths;
    grid.points[i].lengths->left_mm /= 1.0 + kElongation;
    grid.points[i].commanded.reset();
  }
  const Diagnosis after = diagnosed(grid);
  SCOPED_TRACE(after.sentence);
  EXPECT_FALSE(names(before).contains("chain_pitch_error:left")) << before.sentence;
  const auto found = std::find_if(after.causes.begin(), after.causes.end(), [](const Cause& c) {
    return c.cause.effect->id == "chain_pitch_error" &&
           c.cause.side == model::effects::EffectSide::left;
  });
  ASSERT_NE(found, after.causes.end());
  const ParameterEstimate& size = found->parameters.front();
  EXPECT_NEAR(size.value, kElongation, std::max(4.0 * size.sigma, 0.25 * kElongation))
      << "what the machine has of it by itself is in the same number";
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
