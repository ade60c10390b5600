// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/drawing_page.hpp"

#include <fmt/format.h>

#include <vector>

namespace chaintrue::grid {
namespace {

using observation::DrawnMeasure;

/// A straight line, in the machine's frame.
struct DrawnLine {
  model::BedPoint from;
  model::BedPoint to;
};

std::vector<DrawnLine> lines_of(const TestDrawing& drawing) {
  constexpr double kArmMm = 5.0;
  std::vector<DrawnLine> lines;
  for (const DrawnCross& cross : drawing.crosses) {
    const auto [x, y] = cross.commanded;
    lines.push_back({{x - kArmMm, y}, {x + kArmMm, y}});
    lines.push_back({{x, y - kArmMm}, {x, y + kArmMm}});
  }
  for (const DrawnMeasure& m : drawing.measures) {
    if (m.kind == DrawnMeasure::Kind::bow)
      lines.push_back({drawing.crosses.at(m.from).commanded, drawing.crosses.at(m.to).commanded});
  }
  return lines;
}

}  // namespace

std::string drawing_gcode(const TestDrawing& drawing) {
  const PenCommands& pen = drawing.pen;
  const auto at = [&](const model::BedPoint& point) {
    return fmt::format("X{:.3f} Y{:.3f}", point.x_mm + drawing.pins_middle.x_mm,
                       point.y_mm + drawing.pins_middle.y_mm);
  };
  std::string text = fmt::format("G21\nG90\n{}\n", pen.up);
  for (const DrawnLine& line : lines_of(drawing)) {
    text += fmt::format("G0 {}\n{}\nG1 {} F{:.0f}\n{}\n", at(line.from), pen.down, at(line.to),
                        drawing.feed_mm_per_min, pen.up);
  }
  return text;
}

std::string drawing_svg(const TestDrawing& drawing) {
  const model::DrawingArea& area = drawing.machine.area;
  const double width = area.right_mm - area.left_mm, height = area.top_mm - area.bottom_mm;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.3f}mm\" height=\"{1:.3f}mm\" "
      "viewBox=\"0 0 {0:.3f} {1:.3f}\">\n<path fill=\"none\" stroke=\"black\" d=\"",
      width, height);
  for (const DrawnLine& line : lines_of(drawing)) {
    text += fmt::format("M{:.3f},{:.3f} L{:.3f},{:.3f} ", line.from.x_mm - area.left_mm,
                        area.top_mm - line.from.y_mm, line.to.x_mm - area.left_mm,
                        area.top_mm - line.to.y_mm);
  }
  return text + "\"/>\n</svg>\n";
}

std::string measuring_list(const TestDrawing& drawing) {
  std::string text =
      "Lengths: with a ruler or a tape, from the middle of one cross to the middle of the "
      "other.\nBows: hold a string from the first cross to the last, and measure across from the "
      "string to the line at the cross between them.\nA bow is positive if the line is to the left "
      "as you go from the first cross to the last, so above the string for a line that runs to the "
      "right.\n\n";
  for (std::size_t i = 0; i < drawing.measures.size(); ++i)
    text += fmt::format("{:2}. {:<28} ________ mm\n", i + 1, words_of(drawing, i));
  return text;
}

}  // namespace chaintrue::grid
