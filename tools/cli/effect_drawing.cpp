// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "tools/cli/svg.hpp"

namespace chaintrue::cli {

namespace {

// The sheet of paper, in its own units (pixels at 100 %).
constexpr double kWidth = 960.0, kMargin = 30.0, kCaption = 26.0;
constexpr double kSquareSize = 300.0;

constexpr std::string_view kFrame = "fill=\"none\" stroke=\"#999999\"";

std::string stroke_of(std::string_view colour) {
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"", colour);
}

// Exaggeration that turns the largest shift into about `wanted` units.
double exaggeration(double largest, double wanted) {
  constexpr double kNothing = 1e-9;
  return largest > kNothing ? report::round_down_125(wanted / largest) : 1.0;
}

void add_arrow(Svg& svg, double x, double y, double dx, double dy, std::string_view colour) {
  const std::string look = stroke_of(colour);
  svg.circle(x, y, 1.6, look);
  const double length = std::hypot(dx, dy);
  constexpr double kShortest = 1.0;
  if (length < kShortest) return;
  const double head = std::min(6.0, 0.5 * length) / length;
  svg.path(
      fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}M{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} {:.2f}", x, y,
                  x + dx, y + dy, x + dx - head * (dx + 0.5 * dy), y + dy - head * (dy - 0.5 * dx),
                  x + dx, y + dy, x + dx - head * (dx - 0.5 * dy), y + dy - head * (dy + 0.5 * dx)),
      look);
}

void add_bed(Svg& svg, const BedView& view, const synthetic::EffectPicture& picture,
             const Bed& bed) {
  double largest = 0.0;
  for (const synthetic::ShiftedMark& mark : picture.marks)
    largest = std::max({largest, mark.as_stated_mm.norm(), mark.calibrated_mm.norm()});
  const double spacing = view.scale() * bed.width_mm / (picture.columns - 1);
  const double by = exaggeration(largest, 0.6 * spacing);
  const double top = view.y(0.5 * bed.height_mm);
  svg.text(kMargin, top - 10.0,
           fmt::format("The bed: 1 mm at the tool drawn as {} units; largest {} mm", by,
                       short_number(largest)));
  svg.rectangle(kMargin, top, view.scale() * bed.width_mm, view.high(), kFrame);
  for (const synthetic::ShiftedMark& mark : picture.marks) {
    const auto add = [&](const Eigen::Vector2d& shift_mm, std::string_view colour) {
      add_arrow(svg, view.x(mark.mark.x_mm), view.y(mark.mark.y_mm), by * shift_mm.x(),
                -by * shift_mm.y(), colour);
    };
    add(mark.as_stated_mm, report::kBeforeColor);
    add(mark.calibrated_mm, report::kAfterColor);
  }
}

void add_square(Svg& svg, const synthetic::ShiftedSquare& square, double left, double top) {
  double largest = 0.0;
  for (const Eigen::Vector2d& shift : square.corner_shift_mm)
    largest = std::max(largest, shift.norm());
  const double by = exaggeration(largest, 0.25 * kSquareSize);
  const double half = 0.5 * kSquareSize;
  constexpr double kCorners[][2] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};
  std::string outline;
  for (const auto i : each_index(square.corner_shift_mm)) {
    const Eigen::Vector2d& shift = square.corner_shift_mm[i];
    outline += fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : "L",
                           left + half * (1.0 + kCorners[i][0]) + by * shift.x(),
                           top + half * (1.0 - kCorners[i][1]) - by * shift.y());
  }
  svg.text(left, top - 10.0,
           fmt::format("{:.0f} mm square at ({:.0f}, {:.0f}) mm, errors times {}", square.size_mm,
                       square.centre.x_mm, square.centre.y_mm,
                       short_number(by * square.size_mm / kSquareSize)));
  svg.rectangle(left, top, kSquareSize, kSquareSize, kFrame);
  svg.path(outline + "Z", stroke_of(report::kBeforeColor));
}

}  // namespace

std::string draw_effect(const Machine& machine, const synthetic::EffectPicture& picture) {
  const Bed& bed = machine.bed;
  const BedView view{grid::area_of(bed), {kMargin, 3.0 * kCaption}, kWidth - 2.0 * kMargin};
  const double squares_top = view.y(-0.5 * bed.height_mm) + 3.0 * kCaption;
  std::string title = picture.applied.effect;
  if (!picture.applied.side.empty()) title += " " + picture.applied.side;
  for (const auto& [key, value] : picture.applied.parameters)
    title += fmt::format(", {} {}", key, short_number(value));
  Svg svg(kWidth, squares_top + kSquareSize + 3.0 * kCaption, "font-size=\"14\"", title);
  svg.fill();
  svg.text(kMargin, 22.0, title);
  svg.text(kMargin, 42.0,
           "The tool's error: with the machine file as it is (orange), and after calibrating "
           "motors and zeros (blue)");
  add_bed(svg, view, picture, bed);
  for (const auto i : each_index(picture.squares))
    add_square(svg, picture.squares[i], 90.0 + as_double(i) * (kSquareSize + 180.0), squares_top);
  return svg.finished();
}

std::string short_number(double value) { return fmt::format("{:.3g}", value); }

// A self-explanatory drawing of a cut square.
namespace {

// The picture, in its own units.
constexpr double kWide = 640.0, kHigh = 700.0, kSide = 400.0, kSquareLeft = 120.0,
                 kSquareTop = 110.0;
constexpr double kLargestError = 0.11;  // share of the side that the largest error is drawn as

/// The outlines as points of the picture, the cut one about its own middle, so that shape alone
/// shows.
struct Outlines {
  Words commanded, cut;
  double magnification = 1.0;
};

Outlines outlines_of(const CutSquare& square, const SquareTask& task) {
  std::vector<Eigen::Vector2d> errors;
  double largest = 0.0;
  for (const auto i : each_index(square.cut)) {
    const BedPoint &cut = square.cut[i], &commanded = square.commanded[i];
    errors.emplace_back(cut.x_mm - commanded.x_mm - square.offset.x_mm,
                        cut.y_mm - commanded.y_mm - square.offset.y_mm);
    largest = std::max(largest, errors[i].norm());
  }
  Outlines outlines;
  // A round factor; a perfect square, up to rounding, is not magnified.
  constexpr double kRoundingMm = 1e-6;
  if (largest > kRoundingMm) {
    outlines.magnification =
        std::max(1.0, report::round_down_125(kLargestError * task.size_mm / largest));
  }
  const double scale = kSide / task.size_mm;
  const BedPoint& first = square.commanded.front();
  const auto at = [&](double x_mm, double y_mm) {
    return fmt::format("{:.2f},{:.2f}", kSquareLeft + scale * (x_mm - first.x_mm),
                       kSquareTop + scale * (first.y_mm + task.size_mm - y_mm));
  };
  for (const auto i : each_index(errors)) {
    const BedPoint& p = square.commanded[i];
    outlines.commanded.push_back(at(p.x_mm, p.y_mm));
    outlines.cut.push_back(at(p.x_mm + outlines.magnification * errors[i].x(),
                              p.y_mm + outlines.magnification * errors[i].y()));
  }
  return outlines;
}

}  // namespace

std::string draw_square(const CutSquare& square, const SquareTask& task) {
  using model::SquareSide;
  const Outlines outlines = outlines_of(square, task);
  const std::string title = fmt::format("A {:g} mm square at ({:g}, {:g}) mm", task.size_mm,
                                        task.corner.x_mm, task.corner.y_mm);
  Svg svg(kWide, kHigh, "font-size=\"15\" fill=\"#222222\"", title);
  svg.fill();
  svg.add(
      R"(<polygon points="{0}" fill="none" stroke="#888888" stroke-width="1.5" stroke-dasharray="7 5"/>
<polygon points="{1}" fill="{2}" fill-opacity="0.08" stroke="{2}" stroke-width="2.5" stroke-linejoin="round"/>
)",
      fmt::join(outlines.commanded, " "), fmt::join(outlines.cut, " "), report::kAfterColor);
  const auto line = [&svg](double y, std::string_view words) {
    svg.text(kWide / 2, y, words, "middle");
  };
  line(34.0, title);
  line(58.0, fmt::format("dashed: commanded \u00b7 solid: cut, errors drawn {:g} times as large",
                         outlines.magnification));
  const auto side = [&square](SquareSide which) {
    const model::CutSide& s = square.side(which);
    return fmt::format("{:.2f} mm, bow {:+.2f}", s.length_mm, s.bow_mm);
  };
  const double middle_y = kSquareTop + kSide / 2;
  line(kSquareTop + 70.0, side(SquareSide::top));
  line(kSquareTop + kSide - 60.0, side(SquareSide::bottom));
  for (const auto& [which, x] : {std::pair(SquareSide::left, kSquareLeft + 70.0),
                                 std::pair(SquareSide::right, kSquareLeft + kSide - 60.0)}) {
    svg.text(x, middle_y, side(which), "middle",
             fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, middle_y));
  }
  line(kSquareTop + kSide + 90.0,
       fmt::format("diagonals: rising {:.2f} mm, falling {:.2f} mm (commanded {:.2f})",
                   square.rising_diagonal_mm, square.falling_diagonal_mm,
                   task.size_mm * std::sqrt(2.0)));
  line(kSquareTop + kSide + 116.0,
       fmt::format("shifted by ({:+.2f}, {:+.2f}) mm and rotated by {:+.3f} mrad",
                   square.offset.x_mm, square.offset.y_mm, 1e3 * square.rotation_rad));
  line(kSquareTop + kSide + 142.0,
       "bow: largest distance of a side from the line between its corners, + outwards");
  return svg.finished();
}

}  // namespace chaintrue::cli
