// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of GroundControl, there and back. What single files become: tests/cli/cases/imports.cases.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path kSettings = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "holey";

TEST(GroundcontrolSettings, TypedInReproduceTheMachine) {
  model::Machine machine;
  machine.controller.kind = model::ControllerKind::holey;  // which alone has a tilt of the beam
  const double spacing = 3603.25;
  const double tilt = 0.1234 * std::numbers::pi / 180.0;
  machine.motors.left = {-0.5 * spacing * std::cos(tilt), 1090.5 - 0.5 * spacing * std::sin(tilt)};
  machine.motors.right = {0.5 * spacing * std::cos(tilt), 1090.5 + 0.5 * spacing * std::sin(tilt)};
  machine.attachment = model::Ring{138.25};
  machine.feed = model::Feed::off_bottom;
  const GroundcontrolText typed = write_groundcontrol(machine);
  const model::Machine again = parse_groundcontrol(typed.text, "typed.ini").machine;
  // Settings are typed to 0.0001; half of that in the tilt is 0.0016 mm at the end of half a beam.
  EXPECT_NEAR(again.motors.left.x_mm, machine.motors.left.x_mm, 1e-4);
  EXPECT_NEAR(again.motors.left.y_mm, machine.motors.left.y_mm, 2e-3);
  EXPECT_NEAR(again.motors.right.y_mm, machine.motors.right.y_mm, 2e-3);
  EXPECT_EQ(std::get<model::Ring>(again.attachment).radius_mm, 138.25);
  EXPECT_EQ(again.feed, model::Feed::off_bottom);
  EXPECT_EQ(again.controller.settings.left_chain_tolerance_percent, 0.0);
  EXPECT_EQ(again.controller.settings.right_chain_tolerance_percent, 0.0);
  // 1e12 (0.14e-3 kg/mm / 11.6 kg)^2 / 24 = 6.0692: the parabola's sag of this chain under this
  // sled.
  EXPECT_EQ(again.controller.settings.chain_sag_correction, 6.0692);
}

/// The numbers of an ini file by key.
std::map<std::string, std::string> entries_of(const std::string& ini) {
  std::map<std::string, std::string> entries;
  std::istringstream lines(ini);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t sign = line.find(" = ");
    if (sign != std::string::npos) entries[line.substr(0, sign)] = line.substr(sign + 3);
  }
  return entries;
}

/// Import, export, import is the identity; no change is reported, and every number of the export
/// equals the file's to the last digit.
void expect_the_way_there_and_back(const std::string& ini) {
  const model::Machine machine = parse_groundcontrol(ini, "any.ini").machine;
  const GroundcontrolText typed = write_groundcontrol(machine);
  EXPECT_THAT(typed.remarks, Each(Not(HasSubstr("changes"))));
  EXPECT_FALSE(says_more_than_its_settings(machine));
  EXPECT_EQ(write_machine(parse_groundcontrol(typed.text, "any.ini").machine),
            write_machine(machine));
  const auto came = entries_of(ini);
  for (const auto& [key, value] : entries_of(typed.text)) {
    const auto own = came.find(key);
    ASSERT_TRUE(own != came.end()) << key << " = " << value << " was not in the file";
    if (std::isalpha(static_cast<unsigned char>(value.front())) != 0) {
      EXPECT_EQ(value, own->second) << key;
    } else {
      EXPECT_EQ(std::stod(value), std::stod(own->second)) << key;
    }
  }
}

TEST(GroundcontrolSettings, RoundTripForEveryFixture) {
  std::vector<std::filesystem::path> files;
  for (const auto& folder : {std::filesystem::path(CHAINTRUE_FIXTURES) / "good", kSettings}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".ini") files.push_back(entry.path());
    }
  }
  EXPECT_GE(files.size(), 2U);
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    expect_the_way_there_and_back(read_whole_file(file));
  }
}

/// A random groundcontrol.ini: any kind of sled, without keys that some programs do not write,
/// numbers with as many digits as programs print.
std::string random_ini(std::mt19937_64& bits) {
  const auto uniform = [&bits](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(bits);
  };
  const auto coin = [&bits] { return std::bernoulli_distribution(0.5)(bits); };
  std::string text = "[Maslow Settings]\n";
  const auto number = [&](const char* key, double low, double high) {
    const double value = uniform(low, high);
    text +=
        coin() ? fmt::format("{} = {}\n", key, value) : fmt::format("{} = {:.4f}\n", key, value);
  };
  number("bedwidth", 1200.0, 3000.0);
  number("bedheight", 700.0, 1500.0);
  number("motorspacingx", 3200.0, 4200.0);
  number("motoroffsety", 300.0, 900.0);
  number("sledwidth", 250.0, 350.0);
  number("sledheight", 100.0, 160.0);
  number("sledcg", 50.0, 90.0);
  text += "zaxis = 1\n[Advanced Settings]\n";
  number("rotationradius", 120.0, 160.0);
  text += fmt::format("kinematicstype = {}\n", coin() ? "Triangular" : "Quadrilateral");
  text += fmt::format("chainoversprocket = {}\n", coin() ? "Top" : "Bottom");
  text +=
      coin() ? "gearteeth = 10\nchainpitch = 6.35\n" : "gearteeth = 12\nchainpitch = 6.3512345\n";
  if (coin()) number("chainsagcorrection", 0.0, 40.0);
  if (coin()) number("topbeamtilt", -0.5, 0.5);
  if (coin()) number("leftchaintolerance", -0.5, 0.5);
  if (coin()) number("rightchaintolerance", -0.5, 0.5);
  if (coin()) number("sledweight", 80.0, 130.0);
  if (coin()) text += fmt::format("chainelongationfactor = {}\n", uniform(4e-6, 9e-6));
  return text;
}

TEST(GroundcontrolSettings, RoundTripForRandomFiles) {
  constexpr std::uint64_t kSeed = 20260816;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937_64 bits(kSeed);
  for (int i = 0; i < 200; ++i) {
    const std::string ini = random_ini(bits);
    SCOPED_TRACE(ini);
    expect_the_way_there_and_back(ini);
  }
}

TEST(GroundcontrolSettings, KeepUndocumentedTolerances) {
  const std::string ini = read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good" /
                                          "groundcontrol_ring.ini");
  model::Machine machine = parse_groundcontrol(ini, "any.ini", Tolerances::unexplained).machine;
  EXPECT_TRUE(machine.effects.empty());
  EXPECT_EQ(machine.controller.settings.left_chain_tolerance_percent, 0.12);
  EXPECT_TRUE(write_groundcontrol(machine).remarks.empty());
  EXPECT_FALSE(says_more_than_its_settings(machine));
  machine.effects.push_back({"chain_pitch_error", "right", {{"elongation", 0.0005}}});
  EXPECT_TRUE(says_more_than_its_settings(machine));
}

TEST(GroundcontrolSettings, ReportTheChangeOfANumber) {
  const std::string ini = read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good" /
                                          "groundcontrol_ring.ini");
  model::Machine machine = parse_groundcontrol(ini, "any.ini").machine;
  machine.motors.left.x_mm -= 1.5;
  machine.motors.right.x_mm += 1.5;
  EXPECT_THAT(write_groundcontrol(machine).remarks,
              ::testing::ElementsAre(
                  "motorspacingx changes from 2978.4 to 2981.4, by the machine's dimensions"));
  EXPECT_TRUE(says_more_than_its_settings(machine));
}

}  // namespace
}  // namespace chaintrue::grid::files
