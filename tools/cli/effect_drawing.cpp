// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/effect_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {
namespace {

using grid::synthetic::EffectPicture;
using grid::synthetic::ShiftedMark;
using grid::synthetic::ShiftedSquare;

// The sheet of paper, in its own units (pixels at 100 %).
constexpr double kWidth = 960.0;
constexpr double kMargin = 30.0;
constexpr double kCaption = 26.0;

// Exaggeration that turns the largest shift into about `wanted` units.
double exaggeration(double largest, double wanted) {
  constexpr double kNothing = 1e-9;
  return largest > kNothing ? report::round_down_125(wanted / largest) : 1.0;
}

std::string text_at(double x, double y, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x, y, words);
}

std::string arrow(double x, double y, double dx, double dy, const char* css_class) {
  const double length = std::hypot(dx, dy);
  std::string svg = fmt::format(
      "<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"1.6\"/>\n", css_class, x, y);
  constexpr double kShortest = 1.0;
  if (length < kShortest) return svg;
  const double ux = dx / length;
  const double uy = dy / length;
  const double head = std::min(6.0, 0.5 * length);
  svg += fmt::format(
      "<path class=\"{}\" d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}M{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} "
      "{:.2f}\"/>\n",
      css_class,
      x,
      y,
      x + dx,
      y + dy,
      x + dx - head * (ux + 0.5 * uy),
      y + dy - head * (uy - 0.5 * ux),
      x + dx,
      y + dy,
      x + dx - head * (ux - 0.5 * uy),
      y + dy - head * (uy + 0.5 * ux));
  return svg;
}

std::string draw_bed(const model::Machine& machine,
                     const EffectPicture& picture,
                     double top,
                     double& bottom) {
  const double scale = (kWidth - 2.0 * kMargin) / machine.bed.width_mm;
  const double height = machine.bed.height_mm * scale;
  const double cx = 0.5 * kWidth;
  const double cy = top + kCaption + 0.5 * height;
  double largest = 0.0;
  for (const ShiftedMark& mark : picture.marks) {
    largest = std::max({largest, mark.as_stated_mm.norm(), mark.calibrated_mm.norm()});
  }
  const double spacing = machine.bed.width_mm / (picture.columns - 1) * scale;
  const double by = exaggeration(largest, 0.6 * spacing);
  std::string svg = text_at(
      kMargin,
      top + 16.0,
      fmt::format(
          "The bed: 1 mm at the tool drawn as {} units; largest {} mm", by, short_number(largest)));
  svg += fmt::format(
      "<rect class=\"bed\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>\n",
      kMargin,
      top + kCaption,
      machine.bed.width_mm * scale,
      height);
  for (const ShiftedMark& mark : picture.marks) {
    const double x = cx + mark.mark.x_mm * scale;
    const double y = cy - mark.mark.y_mm * scale;
    svg += arrow(x, y, by * mark.as_stated_mm.x(), -by * mark.as_stated_mm.y(), "stated");
    svg += arrow(x, y, by * mark.calibrated_mm.x(), -by * mark.calibrated_mm.y(), "calibrated");
  }
  bottom = top + kCaption + height;
  return svg;
}

std::string draw_shifted_square(const ShiftedSquare& square, double left, double top, double size) {
  double largest = 0.0;
  for (const Eigen::Vector2d& shift : square.corner_shift_mm)
    largest = std::max(largest, shift.norm());
  const double scale = size / square.size_mm;
  const double by = exaggeration(largest, 0.25 * size);
  const double half = 0.5 * square.size_mm;
  const double cx = left + 0.5 * size;
  const double cy = top + kCaption + 0.5 * size;
  const double corner_x[] = {-half, half, half, -half};
  const double corner_y[] = {-half, -half, half, half};
  std::string outline;
  for (std::size_t i = 0; i < square.corner_shift_mm.size(); ++i) {
    outline += fmt::format("{}{:.2f} {:.2f}",
                           i == 0 ? "M" : "L",
                           cx + corner_x[i] * scale + by * square.corner_shift_mm[i].x(),
                           cy - corner_y[i] * scale - by * square.corner_shift_mm[i].y());
  }
  std::string svg = text_at(left,
                            top + 16.0,
                            fmt::format("{:.0f} mm square at ({:.0f}, {:.0f}) mm, errors times {}",
                                        square.size_mm,
                                        square.centre.x_mm,
                                        square.centre.y_mm,
                                        short_number(by / scale)));
  svg += fmt::format(
      "<rect class=\"bed\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>\n",
      left,
      top + kCaption,
      size,
      size);
  svg += fmt::format("<path class=\"stated\" d=\"{}Z\"/>\n", outline);
  return svg;
}

}  // namespace

std::string draw_effect(const model::Machine& machine, const EffectPicture& picture) {
  constexpr double kSquareSize = 300.0;
  double bottom = 0.0;
  const double top = 2.0 * kCaption;
  std::string body = draw_bed(machine, picture, top, bottom);
  const double squares_top = bottom + 2.0 * kCaption;
  for (std::size_t i = 0; i < picture.squares.size(); ++i) {
    const double left = 90.0 + static_cast<double>(i) * (kSquareSize + 180.0);
    body += draw_shifted_square(picture.squares[i], left, squares_top, kSquareSize);
  }
  const double height = squares_top + kCaption + kSquareSize + 3.0 * kCaption;
  std::string title = picture.applied.effect;
  if (!picture.applied.side.empty()) title += " " + picture.applied.side;
  for (const auto& [key, value] : picture.applied.parameters)
    title += fmt::format(", {} {}", key, short_number(value));
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" "
             "role=\"img\">\n"
             "<title>{}</title>\n"
             "<style>text{{font:14px "
             "sans-serif}}.bed{{fill:none;stroke:#999}}path{{fill:none;stroke-width:1.6}}"
             ".stated{{stroke:{};fill:none}}.calibrated{{stroke:{};fill:none}}</style>\n"
             "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
             kWidth,
             height,
             title,
             report::kBeforeColor,
             report::kAfterColor) +
         text_at(kMargin, 22.0, title) +
         text_at(kMargin,
                 42.0,
                 "The tool's error: with the machine file as it is (orange), and after "
                 "calibrating motors and zeros (blue)") +
         body + "</svg>\n";
}

std::string short_number(double value) { return fmt::format("{:.3g}", value); }

}  // namespace chaintrue::cli
