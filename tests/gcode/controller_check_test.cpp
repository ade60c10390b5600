// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How unmodified controllers execute a program, by the formulas of their firmware. The messages:
/// tests/cli/cases/gcode_programs.cases.
#include "tools/gcode/controller_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/gcode/program_events.hpp"
#include "tools/gcode/firmware.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

using model::ControllerKind;

constexpr ControllerKind kAll[] = {ControllerKind::ideal, ControllerKind::maslow_classic,
                                   ControllerKind::holey, ControllerKind::fluidnc_wallplotter};

std::vector<Point> chords(ControllerKind kind, const std::string& program) {
  ProgramEvents events;
  EXPECT_TRUE(run_text(program, events));
  std::vector<Point> ends{events.moves.back().from};
  for_each_chord(firmware(kind), events.moves.back(), 1e-3, [&](Point end) {
    ends.push_back(end);
    return true;
  });
  return ends;
}

TEST(FirmwareArc, MaslowsCutChordsByTheirChordHeight) {
  const Firmware& classic = firmware(ControllerKind::maslow_classic);
  // r - sqrt(r^2 - c/4) < 0.01 <=> sin(sweep / 2) < 0.04 - 0.0002 / r: 0.0800 rad for a wide arc,
  // 0.0796 at 1 mm; in float the height of a wide arc is known to one part in 160. Where c > 4 r^2
  // the root is not real, and the arc is kept.
  EXPECT_TRUE(cuts_straight(classic, 1000.0, 0.079));
  EXPECT_FALSE(cuts_straight(classic, 1000.0, 0.081));
  EXPECT_TRUE(cuts_straight(classic, 1.0, 0.0795));
  EXPECT_FALSE(cuts_straight(classic, 1.0, 0.0797));
  EXPECT_FALSE(cuts_straight(classic, 0.004, 0.02));
  EXPECT_TRUE(cuts_straight(classic, 25401.0, 1.0));
  EXPECT_FALSE(cuts_straight(classic, 25399.0, 1.0));
  EXPECT_FALSE(cuts_straight(firmware(ControllerKind::fluidnc_wallplotter), 1000.0, 0.01));
  EXPECT_FALSE(cuts_straight(firmware(ControllerKind::ideal), 1000.0, 0.01));
}

TEST(FirmwareArc, GrblsChordsKeepToTheCircleAndEndWhereTheyShould) {
  // radius, largest distance of a chord's end from the circle: twelve turns by the small-angle
  // formula, each too long by b^4/8 - b^4/24 or so, b = 2 sqrt(2 h / r) the angle of a chord; and 13
  // roundings of single precision.
  for (const double radius : {0.1, 0.5, 1.0, 5.0, 50.0, 500.0}) {
    const double step = 2.0 * std::sqrt(2.0 * 0.002 / radius);
    const double bound =
        radius * (12.0 * std::pow(step, 4) / 8.0 + 13.0 * std::pow(2.0, -23)) + 500.0 * 6e-8;
    const std::string r = std::to_string(radius);
    const auto ends =
        chords(ControllerKind::fluidnc_wallplotter, "G0 X0 Y0\nF600 G3 X0 Y0 I" + r + "\nM2\n");
    // mc_arc: floor(pi r / sqrt(h (2 r - h))) chords in a whole turn.
    EXPECT_EQ(ends.size() - 1,
              std::floor(std::numbers::pi * radius / std::sqrt(0.002 * (2.0 * radius - 0.002))));
    double worst = 0.0;
    for (const Point& end : ends) {
      worst = std::max(worst, std::fabs(std::hypot(end.x_mm - radius, end.y_mm) - radius));
    }
    EXPECT_LE(worst, bound) << "radius " << radius;
    if (radius <= 1.0) {
      EXPECT_GT(worst, 1e-5) << "the small-angle formula at radius " << radius;
    }
    EXPECT_EQ(ends.back(), (Point{0.0, 0.0, 0.0}));
  }
}

TEST(FirmwareArc, EveryRuleGoesTheSameWayRoundInEveryPlane) {
  for (const ControllerKind kind : kAll) {
    for (const std::string program :
         {"G0 X10 Y0 Z0\nF60 G3 X0 Y10 I-10\nM2\n", "G0 X10 Y0 Z0\nF60 G2 X0 Y10 I-10\nM2\n",
          "G0 X10 Y0 Z0\nF60 G3 X10 Y0 Z4 I-10\nM2\n", "G0 X10 Y0 Z0\nG18 F60 G2 X0 Z10 I-10\nM2\n",
          "G0 X0 Y10 Z0\nG19 F60 G3 Y0 Z10 J-10\nM2\n"}) {
      ProgramEvents events;
      ASSERT_TRUE(run_text(program, events));
      const auto ends = chords(kind, program);
      ASSERT_GT(ends.size(), 8U);
      double way = 0.0;
      for (std::size_t i = 1; i < ends.size(); ++i) way += distance_mm(ends[i - 1], ends[i]);
      // Chords that bow by 0.002 mm at 10 mm are shorter than the arc by b^2/24 = 0.007 %; Maslow's
      // whole turn lacks 0.0002 rad, which the last line closes.
      EXPECT_NEAR(way, length_mm(events.moves.back()), 2e-4 * way) << program;
      EXPECT_EQ(ends.back(), events.moves.back().to);
    }
  }
}

/// By each firmware's published division of a straight move.
TEST(ControllerCheck, DividesAMoveAsThePlottersFirmwareDoes) {
  using model::PlotterFirmware;
  const auto pieces = [](PlotterFirmware plotter, double length_mm, double feed_mm_per_min) {
    return pieces_of(firmware(plotter), length_mm, feed_mm_per_min);
  };
  // Marlin: five a second, cut to a whole number, one at least; 1500 mm/min until an F was read.
  EXPECT_EQ(pieces(PlotterFirmware::marlin, 99.0, 600.0), 49.0);
  EXPECT_EQ(pieces(PlotterFirmware::marlin, 99.0, 6000.0), 4.0);
  EXPECT_EQ(pieces(PlotterFirmware::marlin, 0.5, 6000.0), 1.0);
  EXPECT_EQ(pieces(PlotterFirmware::marlin, 100.0, 0.0), 20.0);
  EXPECT_EQ(pieces(PlotterFirmware::mural, 99.5, 600.0), 100.0);
  EXPECT_EQ(pieces(PlotterFirmware::polargraph, 99.0, 600.0), 50.0);
  EXPECT_EQ(pieces(PlotterFirmware::fluidnc, 99.0, 600.0), 9.0);
  for (const PlotterFirmware plotter : model::kPlotterFirmwares)
    EXPECT_EQ(std::string(firmware(plotter).name).starts_with(name(plotter)), true);
  EXPECT_FALSE(firmware(PlotterFirmware::mural).reads_gcode);
  EXPECT_TRUE(firmware(PlotterFirmware::marlin).reads_gcode);
  EXPECT_FALSE(knows_code(firmware(PlotterFirmware::marlin), {'G', 170}));
  EXPECT_TRUE(knows_code(firmware(PlotterFirmware::marlin), {'M', 2800}));
}

}  // namespace
}  // namespace chaintrue::gcode
