// SPDX-License-Identifier: GPL-3.0-or-later
// The importers on one real machine's scans and settings. The figures were read from the files and
// computed by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "grid/files/grid_file.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path kScans = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "optical_grid";
const std::filesystem::path kSettings = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "holey";
constexpr const char* kAbsent = "the real scans and settings are not part of a checkout and are not here";

OpticalOptions with_controller() {
  OpticalOptions options;
  options.machine.controller.kind = model::ControllerKind::maslow_classic;
  return options;
}

const MeasuredPoint& point_at(const MeasuredGrid& grid, double x_mm, double y_mm) {
  const auto found =
      std::find_if(grid.points.begin(), grid.points.end(), [=](const MeasuredPoint& point) {
        return point.mark.x_mm == x_mm && point.mark.y_mm == y_mm;
      });
  if (found == grid.points.end()) throw std::out_of_range("no such point");
  return *found;
}

TEST(OpticalScan, TheFullOneHasEverySquare) {
  const auto file = kScans / "C_2018-09-30_full.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << kAbsent;
  const ReadOptical read = read_optical(file, with_controller());
  EXPECT_EQ(read.squares, 465);
  ASSERT_EQ(read.grid.points.size(), 465U);
  EXPECT_EQ(read.grid.name, "C_2018-09-30_full.csv");
  EXPECT_EQ(read.grid.sheet->shift_mm, 20.0);
  EXPECT_EQ(read.grid.sheet->rotation_mrad, 10.0);
  EXPECT_FALSE(read.grid.noise.has_value());
  // Top left: x -15 * 76.2, y 7 * 76.2; the blocks begin with 13.11 and 2.76.
  const MeasuredPoint& first = read.grid.points.front();
  EXPECT_EQ(first.mark.x_mm, -1143.0);
  EXPECT_EQ(first.mark.y_mm, 533.4);
  EXPECT_EQ(first.commanded->x_mm, -1129.89);
  EXPECT_EQ(first.commanded->y_mm, 536.16);
  EXPECT_FALSE(first.lengths.has_value());
  EXPECT_FALSE(first.order.has_value());
  // The middle of the sheet: 12.20 and 6.75.
  EXPECT_EQ(point_at(read.grid, 0.0, 0.0).commanded->x_mm, 12.20);
  EXPECT_EQ(point_at(read.grid, 0.0, 0.0).commanded->y_mm, 6.75);
  // Bottom right: 9.11 and 15.01.
  const MeasuredPoint& last = read.grid.points.back();
  EXPECT_EQ(last.mark.x_mm, 1143.0);
  EXPECT_EQ(last.mark.y_mm, -533.4);
  EXPECT_EQ(last.commanded->x_mm, 1152.11);
  EXPECT_EQ(last.commanded->y_mm, -518.39);
}

TEST(OpticalScan, SquaresWithZeroInBothBlocksWereNotVisited) {
  const auto file = kScans / "D_2018-10-01_upper_half.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << kAbsent;
  const ReadOptical read = read_optical(file, with_controller());
  EXPECT_EQ(read.grid.points.size(), 247U);
  for (const MeasuredPoint& point : read.grid.points) EXPECT_GE(point.mark.y_mm, 0.0);
  EXPECT_EQ(point_at(read.grid, 0.0, 0.0).commanded->x_mm, 12.30);
  EXPECT_EQ(point_at(read.grid, 0.0, 0.0).commanded->y_mm, 6.83);
  // The written file is a valid grid.
  const ReadGrid again = parse_grid(write_grid(read.grid), "again.json");
  EXPECT_EQ(again.grid.points.size(), 247U);
  EXPECT_EQ(write_grid(again.grid), write_grid(read.grid));
}

std::string scan_of(double x_error, double y_error) {
  std::string text;
  for (const double error : {x_error, y_error}) {
    for (int row = 0; row < 15; ++row) {
      for (int column = 0; column < 31; ++column) text += std::to_string(error) + ",";
      text += "\n";
    }
    text += "\n";
  }
  return text;
}

TEST(OpticalScan, VisitsFollowTheOrderThatWasGiven) {
  struct Case {
    VisitOrder order;
    // Number of the visit at the top left, its right neighbour, the square below it, and at the
    // right end of row two.
    int top_left, right_of_it, below_it, end_of_second_row;
  };
  for (const Case& expected : {Case{VisitOrder::rows, 0, 1, 31, 61},
                               Case{VisitOrder::serpentine_rows, 0, 1, 61, 31},
                               Case{VisitOrder::columns, 0, 15, 1, 451},
                               Case{VisitOrder::serpentine_columns, 0, 29, 1, 451}}) {
    OpticalOptions options = with_controller();
    options.order = expected.order;
    const MeasuredGrid grid = parse_optical(scan_of(10.0, 5.0), "scan.csv", options).grid;
    EXPECT_EQ(point_at(grid, -1143.0, 533.4).order, expected.top_left);
    EXPECT_EQ(point_at(grid, -1066.8, 533.4).order, expected.right_of_it);
    EXPECT_EQ(point_at(grid, -1143.0, 457.2).order, expected.below_it);
    EXPECT_EQ(point_at(grid, 1143.0, 457.2).order, expected.end_of_second_row);
    std::vector<int> all;
    for (const MeasuredPoint& point : grid.points) all.push_back(*point.order);
    std::sort(all.begin(), all.end());
    for (int i = 0; i < 465; ++i) EXPECT_EQ(all[static_cast<std::size_t>(i)], i);
  }
}

TEST(OpticalScan, ThePitchMayDiffer) {
  OpticalOptions options = with_controller();
  options.pitch_mm = 50.0;
  const MeasuredGrid grid = parse_optical(scan_of(10.0, 5.0), "scan.csv", options).grid;
  EXPECT_EQ(grid.points.front().mark.x_mm, -750.0);
  EXPECT_EQ(grid.points.front().mark.y_mm, 350.0);
}

TEST(OpticalScan, NeedsTheControllerThatCarriedTheCommandsOut) {
  OpticalOptions options;
  options.pitch_mm = 3.0;
  try {
    (void)parse_optical(scan_of(10.0, 5.0), "scan.csv", options);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("the machine's /controller: missing, expected the controller that carried"));
    EXPECT_THAT(error.what(),
                HasSubstr("--pitch-mm: found 3, expected a number in mm from 5 to 1000"));
  }
}

TEST(GroundcontrolSettings, OfARealMachineBecomeMachineAndController) {
  const auto file = kSettings / "groundcontrol_2018-09-01b.ini";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << kAbsent;
  const ReadMachine read = read_groundcontrol(file);
  const model::Machine& machine = read.machine;
  EXPECT_EQ(machine.name, "groundcontrol_2018-09-01b.ini");
  EXPECT_EQ(machine.bed.width_mm, 2438.4);
  EXPECT_EQ(machine.bed.height_mm, 1219.2);
  // D/2 = 1801.4361; tilt 0.0727796 deg = 1.2702 mrad; H/2 + Yo = 609.6 + 473.8636 = 1083.4636.
  // cos: 1801.4361 (1 - 8.067e-7) = 1801.43465; sin: 1801.4361 * 0.00127024 = 2.28826. Both to the
  // computed digits.
  EXPECT_NEAR(machine.motors.right.x_mm, 1801.43465, 1e-5);
  EXPECT_NEAR(machine.motors.left.x_mm, -1801.43465, 1e-5);
  EXPECT_NEAR(machine.motors.right.y_mm, 1085.75186, 1e-5);
  EXPECT_NEAR(machine.motors.left.y_mm, 1081.17534, 1e-5);
  EXPECT_EQ(std::get<model::Ring>(machine.attachment).radius_mm, 139.1003);
  EXPECT_EQ(machine.sprocket.teeth, 10);
  EXPECT_EQ(machine.sprocket.pitch_mm, 6.35);
  // [Computed Settings] has a radius of 10.1904; it is not used.
  EXPECT_FALSE(machine.sprocket.radius_mm.has_value());
  EXPECT_EQ(machine.feed, model::Feed::over_top);
  EXPECT_EQ(machine.controller.kind, model::ControllerKind::maslow_classic);
  const model::ControllerSettings& settings = machine.controller.settings;
  EXPECT_EQ(settings.motor_spacing_mm, 3602.8722);
  EXPECT_EQ(settings.motor_offset_y_mm, 473.8636);
  EXPECT_EQ(settings.rotation_radius_mm, 139.1003);
  EXPECT_EQ(settings.chain_sag_correction, 28.969761);
  EXPECT_EQ(settings.left_chain_tolerance_percent, 0.1237252);
  EXPECT_EQ(settings.right_chain_tolerance_percent, 0.1683196);
  EXPECT_EQ(settings.top_beam_tilt_deg, 0.0727796);
  EXPECT_EQ(settings.chain_pitch_mm, 6.35);
  EXPECT_EQ(settings.gear_teeth, 10.0);
  EXPECT_EQ(settings.chain_over_sprocket_top, true);
  EXPECT_EQ(settings.sled_weight_n, std::nullopt);
  EXPECT_EQ(settings.chain_elongation_per_n, std::nullopt);
  // Not in the file.
  EXPECT_EQ(machine.sled.mass_kg, 11.6);
  EXPECT_EQ(machine.chain.mass_kg_per_m, 0.14);
  EXPECT_EQ(machine.chain.compliance_per_n, 5.1685e-6);
  EXPECT_EQ(machine.frame.tilt_from_vertical_deg, 15.0);
  ASSERT_EQ(read.warnings.size(), 8U);
  for (std::size_t i = 1; i < 6; ++i) EXPECT_THAT(read.warnings[i].sentence, HasSubstr("assumed"));
  // Chain and sled of the default machine make 6.1; 28.97 took up other errors.
  EXPECT_THAT(read.warnings[6].sentence, HasSubstr("chainsagcorrection 28.9698: the weights of chain and sled make 6.1"));
  EXPECT_THAT(read.warnings[7].sentence, HasSubstr("ignored, because"));
  // The tolerances are the pitch that the owner measured for each chain.
  EXPECT_THAT(read.warnings.front().sentence,
              HasSubstr("0.123725 % longer (left) and 0.16832 % longer (right) than new, each number good to 0.1 %"));
  ASSERT_EQ(machine.effects.size(), 2U);
  EXPECT_EQ(machine.effects[0].effect, "chain_pitch_error");
  EXPECT_EQ(machine.effects[0].side, "left");
  EXPECT_EQ(machine.effects[0].parameters.at("elongation"), 0.1237252 / 100.0);
  EXPECT_EQ(machine.effects[1].side, "right");
  EXPECT_EQ(machine.effects[1].parameters.at("elongation"), 0.1683196 / 100.0);
}

TEST(GroundcontrolSettings, OfTheDayBeforeAsWell) {
  const auto file = kSettings / "groundcontrol-BeforeOpt2_2018-09-01.ini";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << kAbsent;
  const model::Machine machine = read_groundcontrol(file).machine;
  // D/2 = 1801.355465, tilt 0.04259 deg = 0.743336 mrad, H/2 + Yo = 1083.94945: y = 1083.94945
  // -+ 1.33901.
  EXPECT_NEAR(machine.motors.left.y_mm, 1082.61044, 1e-5);
  EXPECT_NEAR(machine.motors.right.y_mm, 1085.28846, 1e-5);
  EXPECT_EQ(std::get<model::Ring>(machine.attachment).radius_mm, 138.832);
}

TEST(GroundcontrolSettings, AQuadrilateralHasBrackets) {
  const model::Machine machine = read_groundcontrol(std::filesystem::path(CHAINTRUE_FIXTURES) /
                                                    "good" / "groundcontrol_brackets.ini")
                                     .machine;
  const auto& brackets = std::get<model::Brackets>(machine.attachment);
  EXPECT_EQ(brackets.spacing_mm, 310.0);
  EXPECT_EQ(brackets.height_mm, 139.0);
  EXPECT_EQ(brackets.cg_below_bit_mm, 79.0);
  // 97.9 N / 9.80665 m/s^2 = 9.98302 kg, to the digits given.
  EXPECT_NEAR(machine.sled.mass_kg, 9.98302, 1e-5);
  EXPECT_EQ(machine.chain.compliance_per_n, 8.1e-6);
}

TEST(GroundcontrolSettings, TypedInGiveTheMachineBack) {
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

TEST(GroundcontrolSettings, OfEveryFileThatIsHereGoThereAndBack) {
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

TEST(GroundcontrolSettings, OfTwoHundredRandomFilesGoThereAndBack) {
  constexpr std::uint64_t kSeed = 20260816;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937_64 bits(kSeed);
  for (int i = 0; i < 200; ++i) {
    const std::string ini = random_ini(bits);
    SCOPED_TRACE(ini);
    expect_the_way_there_and_back(ini);
  }
}

TEST(GroundcontrolSettings, TolerancesThatNobodyExplainsStayWithTheController) {
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

TEST(GroundcontrolSettings, SayByWhatANumberChanges) {
  const std::string ini = read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good" /
                                          "groundcontrol_ring.ini");
  model::Machine machine = parse_groundcontrol(ini, "any.ini").machine;
  machine.motors.left.x_mm -= 1.5;
  machine.motors.right.x_mm += 1.5;
  EXPECT_THAT(write_groundcontrol(machine).remarks,
              ::testing::ElementsAre(
                  "motorspacingx changes from 2978.4 to 2981.4, by the measures of the machine"));
  EXPECT_TRUE(says_more_than_its_settings(machine));
}

}  // namespace
}  // namespace chaintrue::grid::files
