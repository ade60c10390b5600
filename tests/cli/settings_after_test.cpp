// SPDX-License-Identifier: GPL-3.0-or-later
// After typing in better numbers, the map of --map-after is right and the previous one is not: what
// the tool of a worn machine does under the firmware's formulas (tests/model/seeds_test.cpp), computed
// from what was written. What check and compensate say of settings: tests/cli/cases/settings.cases.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "grid/files/groundcontrol_file.hpp"
#include "model/controllers/payout.hpp"
#include "model/reading_model.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/support/random.hpp"

namespace chaintrue {
namespace {

using model::BedPoint;
using testing_support::Outcome;

/// Worn chains, motors and ring some millimetres off the typed values.
model::Machine true_machine() {
  model::Machine machine;
  machine.motors = {{-1492.0, 1074.4}, {1491.3, 1071.2}};
  machine.attachment = model::Ring{140.6};
  machine.chain_zero = {0.6, -0.5};
  machine.effects = {{"chain_pitch_error", "left", {{"elongation", 0.0012}}},
                     {"chain_pitch_error", "right", {{"elongation", 0.0017}}}};
  return machine;
}

/// Where the true machine's tool comes to rest for a command to a controller with these settings.
BedPoint reached(const std::string& settings, BedPoint command, BedPoint near) {
  const model::Machine set = grid::files::parse_groundcontrol(settings, "settings.ini").machine;
  const auto paid_out = model::make_controller_kinematics(set)->lengths(command).value();
  return model::ReadingModel(true_machine()).find(paid_out, near).value().pose.position;
}

constexpr const char* kTyped =
    "[Maslow Settings]\nbedwidth = 2438.4\nbedheight = 1219.2\nmotorspacingx = 2978.4\n"
    "motoroffsety = 463\n\n[Advanced Settings]\nkinematicstype = Triangular\n"
    "rotationradius = 139.1\nchainsagcorrection = 6.1\nchainpitch = 6.35\ngearteeth = 10\n"
    "leftchaintolerance = 0.12\nrightchaintolerance = 0.17\nchainoversprocket = Top\n";

/// A raster of places on the measured part.
std::vector<BedPoint> raster(int columns, int rows, double half_x, double half_y) {
  std::vector<BedPoint> places;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      places.push_back(
          {half_x * (2.0 * column / (columns - 1) - 1.0), half_y * (2.0 * row / (rows - 1) - 1.0)});
  }
  return places;
}

/// Holes where the map's points are not.
std::vector<BedPoint> drilled() { return raster(6, 3, 950.0, 380.0); }

std::string drill_program() {
  std::string text = "G21 G90\nG0 Z5\n";
  for (const BedPoint& place : drilled())
    text += fmt::format("G0 X{:.3f} Y{:.3f}\nG1 Z-2 F300\nG0 Z5\n", place.x_mm, place.y_mm);
  return text + "M2\n";
}

/// Where a program plunges, in program coordinates.
std::vector<BedPoint> plunges(const std::string& program) {
  std::vector<BedPoint> places;
  BedPoint here;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("(")) continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      if (word.front() == 'X') here.x_mm = std::stod(word.substr(1));
      if (word.front() == 'Y') here.y_mm = std::stod(word.substr(1));
      if (word == "Z-2") places.push_back(here);
    }
  }
  return places;
}

enum class Measured { commanded_marks, chain_lengths };

class SettingsAfter : public testing_support::CommandFixture,
                      public testing::WithParamInterface<Measured> {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    write("typed.ini", kTyped);
    write("part.nc", drill_program());
    done("import groundcontrol typed.ini -o machine.json");
    write("marks.csv", measured());
    done("fit marks.csv --machine machine.json -o map.json");
    done("export groundcontrol map.json -o settings.ini --map-after map.after.json");
    now_ = testing_support::content_of(folder_ / "settings.ini");
  }

  /// A session with the old numbers: places to 0.3 mm, lengths to 0.2.
  std::string measured() const {
    testing_support::Random random(7);
    const auto off = [&](double sigma_mm) { return sigma_mm * random.normal(); };
    const bool commanded = GetParam() == Measured::commanded_marks;
    std::string text =
        commanded ? "commanded_x_mm,commanded_y_mm,x_mm,y_mm\n" : "x_mm,y_mm,left_mm,right_mm\n";
    for (const BedPoint& mark : raster(7, 4, 1100.0, 500.0)) {
      const BedPoint went = reached(kTyped, mark, mark);
      const model::ChainLengths read = model::ReadingModel(true_machine()).at(mark)->lengths;
      text += commanded
                  ? fmt::format("{},{},{:.3f},{:.3f}\n", mark.x_mm, mark.y_mm, went.x_mm + off(0.3),
                                went.y_mm + off(0.3))
                  : fmt::format("{},{},{:.3f},{:.3f}\n", mark.x_mm + off(0.3), mark.y_mm + off(0.3),
                                read.left_mm + off(0.2), read.right_mm + off(0.2));
    }
    return text;
  }

  /// Rms of where the machine, whose controller holds the new numbers, drills the program.
  double true_error_mm(const std::string& program) const {
    const std::vector<BedPoint> commands = plunges(testing_support::content_of(folder_ / program));
    const std::vector<BedPoint> meant = drilled();
    EXPECT_EQ(commands.size(), meant.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < meant.size(); ++i) {
      const BedPoint went = reached(now_, commands[i], meant[i]);
      sum += std::pow(went.x_mm - meant[i].x_mm, 2) + std::pow(went.y_mm - meant[i].y_mm, 2);
    }
    return std::sqrt(sum / static_cast<double>(meant.size()));
  }

  std::string now_;
};

double stated_mm(const std::string& talk) {
  const std::string words = "Expect cuts within about ";
  const std::size_t at = talk.find(words);
  return at == std::string::npos ? std::nan("") : std::stod(talk.substr(at + words.size()));
}

TEST_P(SettingsAfter, OnlyTheNewMapIsRight) {
  const double stated =
      stated_mm(done("gcode compensate part.nc --map map.after.json -o after.nc").err);
  done("gcode compensate part.nc --map map.json -o before.nc");
  const double after = true_error_mm("after.nc");
  const double before = true_error_mm("before.nc");
  const double typed_alone = true_error_mm("part.nc");
  // One draw of a smooth error over the bed has few independent parts: twice its sigma is rare.
  EXPECT_LT(after, 2.0 * stated);
  // The old map repeats the correction by the numbers.
  EXPECT_GT(before, 2.0);
  // Settings cannot describe a beam that rises and is not centred on the bed; the map can.
  EXPECT_LT(after, 0.5 * typed_alone);
}

INSTANTIATE_TEST_SUITE_P(Ways, SettingsAfter,
                         testing::Values(Measured::commanded_marks, Measured::chain_lengths),
                         [](const auto& way) {
                           return way.param == Measured::commanded_marks ? "CommandedMarks"
                                                                         : "ChainLengths";
                         });

}  // namespace
}  // namespace chaintrue
