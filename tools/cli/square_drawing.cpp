// SPDX-License-Identifier: GPL-3.0-or-later
// A self-explanatory drawing of a cut square.
#include <algorithm>
#include <cmath>

#include "tools/cli/effect_drawing.hpp"
#include "tools/cli/svg.hpp"

namespace chaintrue::cli {
namespace {

// The picture, in its own units.
constexpr double kWide = 640.0, kHigh = 700.0, kSide = 400.0, kSquareLeft = 120.0,
                 kSquareTop = 110.0;
constexpr double kLargestError = 0.11;  // share of the side that the largest error is drawn as

/// The outlines as points of the picture, the cut one about its own middle, so that shape alone
/// shows.
struct Outlines {
  std::vector<std::string> commanded, cut;
  double magnification = 1.0;
};

Outlines outlines_of(const model::CutSquare& square, const SquareTask& task) {
  std::vector<Eigen::Vector2d> errors;
  double largest = 0.0;
  for (std::size_t i = 0; i < square.cut.size(); ++i) {
    const BedPoint &cut = square.cut[i], &commanded = square.commanded[i];
    errors.emplace_back(cut.x_mm - commanded.x_mm - square.offset.x_mm,
                        cut.y_mm - commanded.y_mm - square.offset.y_mm);
    largest = std::max(largest, std::hypot(errors[i].x(), errors[i].y()));
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
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const BedPoint& p = square.commanded[i];
    outlines.commanded.push_back(at(p.x_mm, p.y_mm));
    outlines.cut.push_back(at(p.x_mm + outlines.magnification * errors[i].x(),
                              p.y_mm + outlines.magnification * errors[i].y()));
  }
  return outlines;
}

}  // namespace

std::string draw_square(const model::CutSquare& square, const SquareTask& task) {
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
