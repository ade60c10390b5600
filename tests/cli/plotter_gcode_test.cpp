// SPDX-License-Identifier: GPL-3.0-or-later
// A drawing's fit instead of a map: G-code for a plotter with Marlin whose gondola tilts and whose
// pins are not level, for which Marlin has no setting. Pens hang by tests/lab/generator.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "generator/hidden/plotter.hpp"
#include "model/plotter/plotter_controller.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/cli/ruler.hpp"

namespace chaintrue::plotter_gcode_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::content_of;
using testing_support::Outcome;
using Json = nlohmann::ordered_json;

constexpr double kSpacingMm = 1200.0;
/// In the controller's coordinates the pins are here.
constexpr double kMiddleX = 600.0, kMiddleY = 900.0;

/// Without typing numbers in first, corrections are some hundredths of the drawing.
const std::string kSteep = " --steepest-correction 0.1";

Json stated_plotter(const std::string& firmware) {
  Json plotter = Json::parse(R"({
  "file_type": "chaintrue_plotter", "format_version": "1.0",
  "set": {"machine": {
      "name": "string pen", "pin_spacing_mm": 1200, "motors": "wall",
      "gondola": {"spacing_mm": 60, "pen_below_mm": 30, "mass_below_mm": 40, "mass_kg": 0.4},
      "area": {"left_mm": -350, "right_mm": 350, "top_mm": -300, "bottom_mm": -900}},
    "steps_per_mm": {"left": 80, "right": 80}, "home": {"x_mm": 0, "y_mm": -700},
    "pins_middle": {"x_mm": 600, "y_mm": 900},
    "pen": {"up": "M280 P0 S90", "down": "M280 P0 S30"}, "feed_mm_per_min": 1800}})");
  plotter["set"]["firmware"] = firmware;
  return plotter;
}

/// Wider by 5 mm, the right pin 7 mm high, cords hung 6 and 3 mm long, one counted 1.5 mm in a metre.
class HiddenPlotter {
 public:
  HiddenPlotter() {
    plotter_.pin_spacing_mm = kSpacingMm + 5.0;
    plotter_.pin_rise_mm = 7.0;
    plotter_.spacing_mm = 60.0;
    plotter_.pen_below_mm = 30.0;
    plotter_.mass_below_mm = 40.0;
    plotter_.weight_n = 0.4 * 9.80665;
  }
  /// For a command in the frame of the pins.
  generator::PenAtRest pen(double x_mm, double y_mm) const {
    model::PlotterMachine set;
    set.pin_spacing_mm = kSpacingMm;
    const auto counted = model::paid_out(model::PlotterFirmware::marlin, set, {x_mm, y_mm});
    EXPECT_TRUE(counted);
    return generator::lowest_pose(plotter_, counted->left_mm - 6.0,
                                  (counted->right_mm - 3.0) / 1.0015);
  }

 private:
  generator::HiddenPlotter plotter_;
};

/// Where the lines of a program take the commands to, in the frame of the pins.
std::vector<std::array<double, 2>> places_of(const std::string& program) {
  std::vector<std::array<double, 2>> places;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t x = line.find(" X"), y = line.find(" Y");
    if (!line.starts_with("G") || x == std::string::npos || y == std::string::npos) continue;
    places.push_back(
        {std::stod(line.substr(x + 2)) - kMiddleX, std::stod(line.substr(y + 2)) - kMiddleY});
  }
  return places;
}

class PlotterGcode : public testing_support::CommandFixture {
 protected:
  /// found.json of a drawing that the hidden plotter drew.
  void fit(const std::string& firmware = "marlin") const {
    write("plotter.json", stated_plotter(firmware).dump(1));
    done("start plotter.json first");
    const Json drawing = Json::parse(content_of(folder_ / "first" / "drawing.json"));
    write("drawing.json",
          testing_support::ruled(
              drawing, [&](double x, double y) { return hidden_.pen(x, y); }, 0.3, 11)
              .dump(1));
    done("fit drawing.json -o found.json");
  }
  std::array<double, 2> drawn(const std::array<double, 2>& command) const {
    const auto pen = hidden_.pen(command[0], command[1]);
    return {pen.x_mm, pen.y_mm};
  }
  HiddenPlotter hidden_;
};

double apart(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// The largest error of all distances between the corners of a square of this side.
double worst_distance(const std::vector<std::array<double, 2>>& corners, double side_mm) {
  double worst = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = i + 1; k < corners.size(); ++k) {
      const double wanted = side_mm * ((k - i) % 2 == 1 ? 1.0 : std::sqrt(2.0));
      worst = std::max(worst, std::abs(apart(corners[i], corners[k]) - wanted));
    }
  }
  return worst;
}

TEST_F(PlotterGcode, ACompensatedSquareIsSquareAndItsLinesAreStraight) {
  fit();
  const Outcome square = done("square --map found.json --size-mm 500 --gcode square.gcode");
  const std::string program = content_of(folder_ / "square.gcode");
  EXPECT_THAT(program, AllOf(HasSubstr("M280 P0 S30\n"), Not(HasSubstr("Z")), Not(HasSubstr("("))));
  std::vector<std::array<double, 2>> corners;
  for (const auto& place : places_of(program)) corners.push_back(drawn(place));
  ASSERT_EQ(corners.size(), 5U);
  corners.pop_back();
  const double before = worst_distance(corners, 500.0);
  EXPECT_GT(before, 3.0);
  // square agrees for the fitted plotter: a ruler's readings are within their noise.
  const Outcome sides = done("square --map found.json --size-mm 500 --json");
  const Json predicted = Json::parse(sides.out);
  EXPECT_NEAR(predicted["sides"]["left"]["length_mm"], apart(corners[0], corners[1]), 0.6);
  EXPECT_NEAR(predicted["sides"]["top"]["length_mm"], apart(corners[1], corners[2]), 0.6);

  const Outcome made =
      done("gcode compensate square.gcode --map found.json -o true.gcode" + kSteep);
  EXPECT_THAT(made.err, HasSubstr("Expect cuts within about 0."));
  const std::string compensated = content_of(folder_ / "true.gcode");
  EXPECT_THAT(compensated, AllOf(HasSubstr(";compensated by chaintrue"), HasSubstr("\nG21\nG90\n"),
                                 HasSubstr("M280 P0 S30\n"), Not(HasSubstr("("))));
  // Corners stand where the pen goes up or down and where the direction turns: of each side the places
  // between lie on the line of its ends.
  std::vector<std::array<double, 2>> path;
  for (const auto& place : places_of(compensated)) path.push_back(drawn(place));
  std::vector<std::size_t> turns = {0};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const double ax = path[i][0] - path[i - 1][0], ay = path[i][1] - path[i - 1][1];
    const double bx = path[i + 1][0] - path[i][0], by = path[i + 1][1] - path[i][1];
    if (std::abs(std::atan2(ax * by - ay * bx, ax * bx + ay * by)) > 0.8) turns.push_back(i);
  }
  turns.push_back(path.size() - 1);
  ASSERT_EQ(turns.size(), 5U);
  std::vector<std::array<double, 2>> found;
  double bow = 0.0;
  for (std::size_t side = 0; side < 4; ++side) {
    const auto &a = path[turns[side]], &b = path[turns[side + 1]];
    found.push_back(a);
    for (std::size_t i = turns[side]; i < turns[side + 1]; ++i) {
      bow = std::max(
          bow, std::abs((b[0] - a[0]) * (path[i][1] - a[1]) - (b[1] - a[1]) * (path[i][0] - a[0])) /
                   apart(a, b));
    }
  }
  // The ruler's 0.3 mm on 24 measures give about this error.
  EXPECT_LT(worst_distance(found, 500.0), 0.6);
  EXPECT_LT(bow, 0.3);
  EXPECT_LT(worst_distance(found, 500.0), 0.2 * before);

  done("gcode verify square.gcode true.gcode --map found.json" + kSteep);
  const Outcome plain = run("gcode verify square.gcode square.gcode --map found.json");
  EXPECT_EQ(plain.code, 1);
}

TEST_F(PlotterGcode, FluidNcGetsTheSameProgram) {
  fit("fluidnc");
  done("square --map found.json --size-mm 300 --at 450 200 --gcode square.gcode");
  done("gcode compensate square.gcode --map found.json -o true.gcode --report path.html" + kSteep);
  EXPECT_TRUE(exists("path.html"));
  done("gcode verify square.gcode true.gcode --map found.json" + kSteep);
  const Outcome checked = done("gcode check square.gcode --map found.json" + kSteep);
  const Outcome there = done("query found.json 600 200 --json");
  const Json lengths = Json::parse(there.out);
  const Json& first = lengths.is_array() ? lengths[0] : lengths;
  const Outcome back = done("query found.json --json --inverse " + first["left_mm"].dump() + " " +
                            first["right_mm"].dump());
  EXPECT_NEAR(Json::parse(back.out)["x_mm"], 600.0, 1e-5);  // lengths are printed to 1e-6 mm
  EXPECT_NEAR(Json::parse(back.out)["y_mm"], 200.0, 1e-5);
}

}  // namespace
}  // namespace chaintrue::plotter_gcode_test
