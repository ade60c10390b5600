// SPDX-License-Identifier: GPL-3.0-or-later
// After typing in better numbers, the map of --map-after is right and the previous one is not. The
// machine is the hidden side's own (tests/lab/generator), the controller is written down here from
// the firmware's description, and what the tool does is computed from what was written: the
// product's models decide nothing. What check and compensate say of settings:
// tests/cli/cases/settings.cases.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/random.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using generator::Lengths;
using generator::Vec2;
using testing_support::Outcome;

using Settings = std::map<std::string, double>;

/// MaslowCNC/Firmware, Kinematics.cpp, triangularInverse, over the top.
Lengths paid_out(const Settings& s, Vec2 command) {
  const double r = s.at("chainpitch") * s.at("gearteeth") / (2.0 * std::numbers::pi);
  std::array<double, 2> angle{};
  std::array<double, 2> straight{};
  for (int side = 0; side < 2; ++side) {
    const double x = 0.5 * s.at("motorspacingx") * (side == 0 ? -1.0 : 1.0);
    const double dy = 0.5 * s.at("bedheight") + s.at("motoroffsety") - command.y;
    const double d = std::hypot(command.x - x, dy);
    angle[static_cast<std::size_t>(side)] = std::asin(dy / d) + std::asin(r / d);
    straight[static_cast<std::size_t>(side)] = std::sqrt(d * d - r * r);
  }
  Lengths lengths{};
  for (std::size_t side = 0; side < 2; ++side) {
    const double a = angle[side];
    const double other = angle[1 - side];
    const double pull = std::tan(other) * std::cos(a) + std::sin(a);
    const double sag =
        s.at("chainsagcorrection") * 1e-12 * std::pow(std::cos(a) * straight[side] * pull, 2);
    const double tolerance = s.at(side == 0 ? "leftchaintolerance" : "rightchaintolerance") / 100.0;
    lengths[side] =
        r * a + straight[side] * (1.0 + sag) / (1.0 + tolerance) - s.at("rotationradius");
  }
  return lengths;
}

/// The true machine: worn chains, motors and ring some millimetres off the typed values.
class Truth {
 public:
  Truth() {
    machine_.axis = {{{-1492.0, 1074.4}, {1491.3, 1071.2}}};
    machine_.ring_radius_mm = 140.6;
    machine_.chain_zero_mm = {0.6, -0.5};
  }

  [[nodiscard]] Lengths read(Vec2 place) const {
    const std::vector<generator::Visit> visits = {{place, 0}};
    const auto at_rest = generator::rests(machine_, visits);
    if (!at_rest) throw std::runtime_error("the hidden machine has no rest there");
    return generator::readings(machine_, effects_, visits, *at_rest).front();
  }

  /// Where the tool comes to rest with these lengths paid out: Newton by differences.
  [[nodiscard]] Vec2 tool(Lengths paid, Vec2 near) const {
    constexpr double kStepMm = 0.5;
    for (int i = 0; i < 8; ++i) {
      const Lengths here = read(near);
      const Lengths right = read({near.x + kStepMm, near.y});
      const Lengths above = read({near.x, near.y + kStepMm});
      const double a = (right[0] - here[0]) / kStepMm, b = (above[0] - here[0]) / kStepMm;
      const double c = (right[1] - here[1]) / kStepMm, d = (above[1] - here[1]) / kStepMm;
      const double l = paid[0] - here[0], r = paid[1] - here[1];
      const double det = a * d - b * c;
      near.x += (d * l - b * r) / det;
      near.y += (a * r - c * l) / det;
    }
    return near;
  }

 private:
  generator::TrueMachine machine_;
  std::vector<generator::Hidden> effects_ = {
      {generator::Cause::chain_pitch_error, generator::Where::left, 0.0012},
      {generator::Cause::chain_pitch_error, generator::Where::right, 0.0017}};
};

Settings settings_in(const std::string& ini) {
  Settings settings;
  std::istringstream lines(ini);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key, equals;
    double value = 0.0;
    if (words >> key >> equals >> value && equals == "=") settings[key] = value;
  }
  return settings;
}

constexpr const char* kTyped =
    "[Maslow Settings]\nbedwidth = 2438.4\nbedheight = 1219.2\nmotorspacingx = 2978.4\n"
    "motoroffsety = 463\n\n[Advanced Settings]\nkinematicstype = Triangular\n"
    "rotationradius = 139.1\nchainsagcorrection = 6.1\nchainpitch = 6.35\ngearteeth = 10\n"
    "leftchaintolerance = 0.12\nrightchaintolerance = 0.17\nchainoversprocket = Top\n";

/// A raster of places on the measured part.
std::vector<Vec2> raster(int columns, int rows, double half_x, double half_y) {
  std::vector<Vec2> places;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      places.push_back(
          {half_x * (2.0 * column / (columns - 1) - 1.0), half_y * (2.0 * row / (rows - 1) - 1.0)});
  }
  return places;
}

/// Holes where the map's points are not.
std::vector<Vec2> drilled() { return raster(6, 3, 950.0, 380.0); }

std::string drill_program() {
  std::string text = "G21 G90\nG0 Z5\n";
  for (const Vec2& place : drilled())
    text += fmt::format("G0 X{:.3f} Y{:.3f}\nG1 Z-2 F300\nG0 Z5\n", place.x, place.y);
  return text + "M2\n";
}

/// Where a program plunges, in program coordinates.
std::vector<Vec2> plunges(const std::string& program) {
  std::vector<Vec2> places;
  Vec2 here;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("(")) continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      if (word.front() == 'X') here.x = std::stod(word.substr(1));
      if (word.front() == 'Y') here.y = std::stod(word.substr(1));
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
    succeed("import groundcontrol typed.ini -o machine.json");
    write("marks.csv", measured());
    succeed("fit marks.csv --machine machine.json -o map.json");
    succeed("export groundcontrol map.json -o settings.ini --map-after map.after.json");
    now_ = settings_in(testing_support::content_of(folder_ / "settings.ini"));
  }

  std::string succeed(const std::string& line) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.code, 0) << line << "\n" << outcome.err;
    return outcome.err;
  }

  /// A session with the old numbers: places to 0.3 mm, lengths to 0.2.
  [[nodiscard]] std::string measured() const {
    generator::Dice dice(7, "marks");
    const bool commanded = GetParam() == Measured::commanded_marks;
    std::string text =
        commanded ? "commanded_x_mm,commanded_y_mm,x_mm,y_mm\n" : "x_mm,y_mm,left_mm,right_mm\n";
    for (const Vec2& mark : raster(7, 4, 1100.0, 500.0)) {
      if (!commanded) {
        const Lengths read = truth_.read(mark);
        text += fmt::format("{},{},{:.3f},{:.3f}\n",
                            mark.x + 0.3 * dice.normal(),
                            mark.y + 0.3 * dice.normal(),
                            read[0] + 0.2 * dice.normal(),
                            read[1] + 0.2 * dice.normal());
        continue;
      }
      const Vec2 went = truth_.tool(paid_out(settings_in(kTyped), mark), mark);
      text += fmt::format("{},{},{:.3f},{:.3f}\n",
                          mark.x,
                          mark.y,
                          went.x + 0.3 * dice.normal(),
                          went.y + 0.3 * dice.normal());
    }
    return text;
  }

  /// Rms of where the machine, whose controller holds the new numbers, drills the program.
  [[nodiscard]] double true_error_mm(const std::string& program) const {
    const std::vector<Vec2> commands = plunges(testing_support::content_of(folder_ / program));
    const std::vector<Vec2> meant = drilled();
    EXPECT_EQ(commands.size(), meant.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < meant.size(); ++i) {
      const Vec2 went = truth_.tool(paid_out(now_, commands[i]), meant[i]);
      sum += std::pow(went.x - meant[i].x, 2) + std::pow(went.y - meant[i].y, 2);
    }
    return std::sqrt(sum / static_cast<double>(meant.size()));
  }

  Truth truth_;
  Settings now_;
};

double stated_mm(const std::string& talk) {
  const std::string words = "Expect cuts within about ";
  const std::size_t at = talk.find(words);
  return at == std::string::npos ? std::nan("") : std::stod(talk.substr(at + words.size()));
}

TEST_P(SettingsAfter, OnlyTheNewMapIsRight) {
  const double stated =
      stated_mm(succeed("gcode compensate part.nc --map map.after.json -o after.nc"));
  succeed("gcode compensate part.nc --map map.json -o before.nc");
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

INSTANTIATE_TEST_SUITE_P(Ways,
                         SettingsAfter,
                         testing::Values(Measured::commanded_marks, Measured::chain_lengths),
                         [](const auto& way) {
                           return way.param == Measured::commanded_marks ? "CommandedMarks"
                                                                         : "ChainLengths";
                         });

}  // namespace
}  // namespace chaintrue
