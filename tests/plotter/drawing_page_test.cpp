// SPDX-License-Identifier: GPL-3.0-or-later
/// The page draws what is measured: every cross and every line of a bow, inside the drawing area.
#include "grid/plotter/test_drawing.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

namespace chaintrue::grid::plotter_page_test {
namespace {

using model::PlotterFirmware;
using observation::DrawnMeasure;
using testing::HasSubstr;

TestDrawing planned() {
  TestDrawing drawing = planned_drawing({model::PlotterMachine{}, PlotterFirmware::fluidnc});
  drawing.pins_middle = {600.0, 0.0};
  return drawing;
}

TEST(DrawingPage, ThePlanHasACrossAtEveryEndOfEveryMeasure) {
  const TestDrawing drawing = planned();
  EXPECT_EQ(drawing.crosses.size(), 9u);
  EXPECT_EQ(drawing.measures.size(), 24u);
  EXPECT_EQ(std::count_if(drawing.measures.begin(), drawing.measures.end(),
                          [](const auto& m) { return m.kind == DrawnMeasure::Kind::bow; }),
            8);
  for (const DrawnMeasure& m : drawing.measures) {
    ASSERT_LT(std::max({m.from, m.to, m.middle}), drawing.crosses.size());
    if (m.kind != DrawnMeasure::Kind::bow) continue;
    const auto at = [&](std::size_t i) { return drawing.crosses[i].commanded; };
    // The cross of a bow is the middle of its line, to the last bit of sums of 1 m.
    EXPECT_NEAR(at(m.middle).x_mm, 0.5 * (at(m.from).x_mm + at(m.to).x_mm), 1e-12);
    EXPECT_NEAR(at(m.middle).y_mm, 0.5 * (at(m.from).y_mm + at(m.to).y_mm), 1e-12);
  }
  EXPECT_EQ(words_of(drawing, 0), "the length A-B");
  EXPECT_EQ(words_of(drawing, 16), "the bow of A-B at E");
}

TEST(DrawingPage, GcodeLiftsThePenBetweenLines) {
  TestDrawing drawing = planned();
  drawing.pen = {"M5", "M3 S90"};
  const std::string text = drawing_gcode(drawing);
  EXPECT_TRUE(text.starts_with("G21\nG90\nM5\n")) << text.substr(0, 40);
  // The top line of an area from -400 to 400 at -300, in coordinates from the left pin.
  EXPECT_THAT(text, HasSubstr("G0 X200.000 Y-300.000\nM3 S90\nG1 X1000.000 Y-300.000 F1500\nM5\n"));
  int down = 0, drawn = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    down += line == "M3 S90" ? 1 : 0;
    drawn += line.starts_with("G1 ") ? 1 : 0;
  }
  EXPECT_EQ(down, 9 * 2 + 8);
  EXPECT_EQ(drawn, down);
}

TEST(DrawingPage, AMuralsPictureIsItsArea) {
  const TestDrawing drawing = planned_drawing({model::mural(1500.0), PlotterFirmware::mural});
  const std::string text = drawing_svg(drawing);
  EXPECT_THAT(text, HasSubstr("width=\"900.000mm\" height=\"1200.000mm\""));
  EXPECT_THAT(text, HasSubstr("M0.000,0.000 L900.000,0.000 "));
  EXPECT_THAT(text, HasSubstr("M0.000,0.000 L900.000,1200.000 "));
}

TEST(DrawingPage, TheListHasALineForEveryMeasure) {
  const std::string text = measuring_list(planned());
  EXPECT_EQ(std::count(text.begin(), text.end(), '_'), 24 * 8);
  EXPECT_THAT(text, HasSubstr(" 1. the length A-B "));
  EXPECT_THAT(text, HasSubstr("24. the bow of D-B at M "));
}

}  // namespace
}  // namespace chaintrue::grid::plotter_page_test
