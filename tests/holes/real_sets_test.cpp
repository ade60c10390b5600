// SPDX-License-Identifier: GPL-3.0-or-later
// Five sets of holes that one owner cut and measured in August and September 2018, with the
// settings in force (madgrizzle/MaslowCalibration and madgrizzle/HoleyMaslow; see docs/holes.md).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/holes/holes_fit.hpp"

namespace chaintrue::grid {
namespace {

constexpr const char* kFile = CHAINTRUE_SHARED_DATA "/holey/madgrizzle_holey_measurements.csv";

using Line = std::map<std::string, std::string>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line + ",");
  for (std::string cell; std::getline(stream, cell, ',');) result.push_back(cell);
  return result;
}

std::vector<Line> read_lines() {
  std::ifstream file(kFile);
  std::string text;
  std::getline(file, text);
  const std::vector<std::string> header = cells(text);
  std::vector<Line> lines;
  while (std::getline(file, text)) {
    const std::vector<std::string> values = cells(text);
    Line line;
    for (std::size_t i = 0; i < header.size() && i < values.size(); ++i)
      line[header[i]] = values[i];
    lines.push_back(line);
  }
  return lines;
}

/// Where H0 to H8 were commanded.
constexpr model::BedPoint kHoles[] = {{0.0, 0.0},
                                      {-965.2, 355.6},
                                      {-965.2, -355.6},
                                      {965.2, -355.6},
                                      {965.2, 355.6},
                                      {-304.8, 304.8},
                                      {-304.8, -304.8},
                                      {304.8, -304.8},
                                      {304.8, 304.8}};

/// The machine as its owner knew it: sets a to d on one frame (spacing measured with the chains as
/// 3602.6 mm, good to 5 mm), e on the next; a ring kit of 138.14 mm, whose settings wandered from
/// 132.75 to 139.1 mm, so that zeros are known to some 4 mm; the compliance of his own firmware.
model::Machine machine_of(const Line& line) {
  const auto value = [&line](const char* name) { return std::stod(line.at(name)); };
  const bool second_frame = line.at("set") == "e";
  const double half_mm = 0.5 * (second_frame ? 3581.481 : 3602.6);
  const double height_mm = 609.6 + (second_frame ? 478.26 : 474.0);
  model::Machine machine;
  machine.motors = {{-half_mm, height_mm}, {half_mm, height_mm}};
  machine.attachment = model::Ring{138.14};
  machine.chain.compliance_per_n = 8.1e-6;
  machine.uncertainty = {5.0, 4.0, 1.0};
  machine.controller.kind = model::ControllerKind::maslow_classic;
  model::ControllerSettings& settings = machine.controller.settings;
  settings.motor_spacing_mm = value("param_D_mm");
  settings.motor_offset_y_mm = value("param_motorOffsetY_mm");
  settings.rotation_radius_mm = value("param_rotationRadius_mm");
  settings.chain_sag_correction = value("param_chainSagCorrection");
  settings.left_chain_tolerance_percent = value("param_leftChainTol_pct");
  settings.right_chain_tolerance_percent = value("param_rightChainTol_pct");
  settings.top_beam_tilt_deg = value("param_topBeamTilt_deg");
  return machine;
}

/// M5 and M9 are no holes, but feet of a plumb line on a string: left out.
MeasuredHoles set_of(const Line& line) {
  MeasuredHoles set;
  set.name = line.at("set");
  set.machine = machine_of(line);
  const bool nine = !line.at("dH0H5").empty();
  for (std::size_t i = 0; i < (nine ? 9u : 5u); ++i)
    set.holes.push_back({"H" + std::to_string(i), kHoles[i]});
  for (const auto& [name, value] : line) {
    if (name.size() != 5 || name[0] != 'd' || name[3] != 'H' || value.empty()) continue;
    set.distances.push_back({.from = static_cast<std::size_t>(name[2] - '0'),
                             .to = static_cast<std::size_t>(name[4] - '0'),
                             .distance_mm = std::stod(value)});
  }
  return set;
}

struct Pool {
  double all2 = 0.0;
  double good2 = 0.0;
  double sigma2 = 0.0;
  int all = 0;
  int good = 0;
};

void add(Pool& pool, const HolesFit& fit) {
  for (const FittedDistance& distance : fit.distances) {
    pool.all2 += distance.left_out_mm * distance.left_out_mm;
    pool.sigma2 += distance.left_out_sigma_mm * distance.left_out_sigma_mm;
    ++pool.all;
    if (distance.set_aside) continue;
    pool.good2 += distance.left_out_mm * distance.left_out_mm;
    ++pool.good;
  }
}

class RealSets : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFile)) GTEST_SKIP() << "no measurements at " << kFile;
    for (const Line& line : read_lines()) sets_.push_back(set_of(line));
    ASSERT_EQ(sets_.size(), 5u);
  }

  /// What the other sets on the same frame tell of the machine.
  [[nodiscard]] HolesPrior from_others(std::size_t which) const {
    HolesPrior prior = stated_prior(*sets_[which].machine);
    for (std::size_t other = 0; other < sets_.size(); ++other) {
      if (other == which || (other == 4) != (which == 4)) continue;
      const auto fit = fit_holes(sets_[other], prior);
      if (fit) prior = fit->posterior;
    }
    return prior;
  }

  std::vector<MeasuredHoles> sets_;
};

TEST_F(RealSets, DistancesArePredictedLeftOut) {
  Pool alone;
  Pool together;
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    const auto by_itself = fit_holes(sets_[i]);
    const auto with_others = fit_holes(sets_[i], from_others(i));
    ASSERT_TRUE(by_itself && with_others);
    add(alone, *by_itself);
    add(together, *with_others);
    fmt::print(
        "set {}: alone {:.3f} (fit {:.3f}), with the others {:.3f} (fit {:.3f}), noise {:.2f}\n",
        sets_[i].name,
        by_itself->left_out_all.rms_mm,
        by_itself->left_out_good.rms_mm,
        with_others->left_out_all.rms_mm,
        with_others->left_out_good.rms_mm,
        with_others->noise_factor);
    for (std::size_t k = 0; k < sets_[i].distances.size(); ++k) {
      if (with_others->distances[k].set_aside)
        fmt::print("  set aside: {} {:+.2f} mm\n",
                   words_of(sets_[i], sets_[i].distances[k]),
                   with_others->distances[k].left_out_mm);
    }
  }
  fmt::print("alone: all {:.3f}, those that fit {:.3f}, promised {:.3f}\n",
             std::sqrt(alone.all2 / alone.all),
             std::sqrt(alone.good2 / alone.good),
             std::sqrt(alone.sigma2 / alone.all));
  fmt::print("together: all {:.3f}, those that fit {:.3f}, promised {:.3f}\n",
             std::sqrt(together.all2 / together.all),
             std::sqrt(together.good2 / together.good),
             std::sqrt(together.sigma2 / together.all));
  EXPECT_LE(std::sqrt(together.all2 / together.all), 1.0) << "mm, every distance";
  // 0.6 mm was hoped for; half a millimetre of tape and 0.3 mm of hole at either end do not promise
  // it: left out, a reading is foretold to some 0.7 mm at best.
  EXPECT_LE(std::sqrt(together.good2 / together.good), 0.85) << "mm, those that fit";
  EXPECT_GT(std::sqrt(together.sigma2 / together.all), 0.6);
}

TEST_F(RealSets, TheReadingThatContradictsTheOthersIsNamed) {
  // 1028 mm, where the three other spokes of the same square are 1032 mm.
  const auto fit = fit_holes(sets_[0], from_others(0));
  ASSERT_TRUE(fit);
  for (std::size_t k = 0; k < sets_[0].distances.size(); ++k)
    EXPECT_EQ(fit->distances[k].set_aside, words_of(sets_[0], sets_[0].distances[k]) == "H0-H3");
}

TEST_F(RealSets, WhatADiagnosisSaysOfEach) {
  for (const MeasuredHoles& set : sets_) {
    const auto found = diagnosis::diagnose(set);
    ASSERT_TRUE(found) << found.error().sentence;
    fmt::print("set {}: {}\n", set.name, found->sentence);
    for (const auto& bad : found->bad_points)
      fmt::print("  bad: {} {:+.1f} mm\n", words_of(set, set.distances[bad.index]), bad.off_mm);
  }
}

TEST_F(RealSets, TheChainsScalesAreNamedAndTheMotorsAreNot) {
  // Sets a to d together: the right chain's links are long, the left one's less so; where the
  // motors stand is known no better than their owner stated it.
  const HolesPrior known = from_others(0);
  const Eigen::MatrixXd& c = known.covariance;
  EXPECT_LT(known.mean[7] + 3.0 * std::sqrt(c(7, 7)), 0.0) << "three sigmas below nominal";
  EXPECT_GT(std::sqrt(c(1, 1)), 0.95 * 5.0) << "mm, as stated";
}

}  // namespace
}  // namespace chaintrue::grid
