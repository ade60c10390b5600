// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/test_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "grid/containers.hpp"

namespace chaintrue::grid {
namespace {

using observation::DrawnMeasure;

/// A string's sigmas are known about as well as a ruler's.
constexpr double kRulerDof = 15.0;

constexpr std::string_view kCrosses = "ABCDEFGHM";

std::size_t cross_of(char name) { return kCrosses.find(name); }

}  // namespace

TestDrawing planned_drawing(const SetPlotter& set) {
  const model::DrawingArea& a = set.machine.area;
  const double x = 0.5 * (a.left_mm + a.right_mm), y = 0.5 * (a.bottom_mm + a.top_mm);
  TestDrawing drawing;
  static_cast<SetPlotter&>(drawing) = set;
  drawing.name = set.machine.name;
  const BedPoint places[] = {
      {a.left_mm, a.top_mm},    {a.right_mm, a.top_mm}, {a.right_mm, a.bottom_mm},
      {a.left_mm, a.bottom_mm}, {x, a.top_mm},          {a.right_mm, y},
      {x, a.bottom_mm},         {a.left_mm, y},         {x, y}};
  for (const auto i : each_index(kCrosses))
    drawing.crosses.push_back({std::string(1, kCrosses[i]), places[i]});
  for (const std::string_view ends : {"AB", "HF", "DC", "DA", "GE", "CB", "AC", "DB", "HE", "EF",
                                      "GF", "HG", "AM", "MB", "DM", "MC"}) {
    drawing.measures.push_back({DrawnMeasure::Kind::length, cross_of(ends[0]), cross_of(ends[1])});
    drawing.measures.back().sigma_mm = kRulerSigmaMm;
  }
  for (const std::string_view line : {"AEB", "HMF", "DGC", "DHA", "GME", "CFB", "AMC", "DMB"}) {
    drawing.measures.push_back({DrawnMeasure::Kind::bow, cross_of(line[0]), cross_of(line[2]),
                                cross_of(line[1]), 0.0, kRulerSigmaMm});
  }
  return drawing;
}

tl::expected<observation::DrawnMeasures, CrossFailure> drawn_measures_of(
    const TestDrawing& drawing) {
  std::vector<observation::DrawnPoint> points;
  for (const auto i : each_index(drawing.crosses)) {
    const DrawnCross& cross = drawing.crosses[i];
    const auto lengths = paid_out(drawing.firmware, drawing.machine, cross.commanded);
    if (!lengths) return tl::unexpected(lengths.error().at(i));
    points.push_back({cross.name, {cross.commanded.x_mm, cross.commanded.y_mm}, *lengths});
  }
  return observation::DrawnMeasures(std::move(points), drawing.measures, kRulerDof);
}

std::optional<std::size_t> cross_beyond_belt(const TestDrawing& drawing) {
  if (!drawing.longest_belt_mm) return std::nullopt;
  for (const auto i : each_index(drawing.crosses)) {
    const auto lengths = paid_out(drawing.firmware, drawing.machine, drawing.crosses[i].commanded);
    if (lengths && std::max(lengths->left_mm, lengths->right_mm) > *drawing.longest_belt_mm)
      return i;
  }
  return std::nullopt;
}

std::string words_of(const TestDrawing& drawing, std::size_t measure) {
  const DrawnMeasure& m = drawing.measures.at(measure);
  const auto name = [&](std::size_t cross) { return drawing.crosses.at(cross).name; };
  if (m.kind == DrawnMeasure::Kind::length)
    return fmt::format("the length {}-{}", name(m.from), name(m.to));
  return fmt::format("the bow of {}-{} at {}", name(m.from), name(m.to), name(m.middle));
}

namespace {

/// A straight line, in the machine's frame.
struct DrawnLine {
  BedPoint from;
  BedPoint to;
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
  const auto at = [&](const BedPoint& point) {
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
  for (const auto i : each_index(drawing.measures))
    text += fmt::format("{:2}. {:<28} ________ mm\n", i + 1, words_of(drawing, i));
  return text;
}

}  // namespace chaintrue::grid
