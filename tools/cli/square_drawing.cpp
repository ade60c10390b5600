// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/square_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/cli/svg.hpp"

namespace chaintrue::cli {
namespace {

// The picture, in its own units.
constexpr double kWide = 640.0, kHigh = 700.0, kSide = 400.0, kSquareLeft = 120.0,
                 kSquareTop = 110.0;
constexpr double kLargestError = 0.11;  // share of the side that the largest error is drawn as

/// From the bed to the picture; the cut outline is drawn about its own middle, so that shape alone
/// shows.
class SquarePicture {
 public:
  SquarePicture(const model::CutSquare& square, const SquareTask& task)
      : square_(square),
        scale_(kSide / task.size_mm),
        left_(square.commanded.front().x_mm),
        top_(square.commanded.front().y_mm + task.size_mm) {
    double largest = 0.0;
    for (std::size_t i = 0; i < square.cut.size(); ++i) {
      const BedPoint e = error(i);
      largest = std::max(largest, std::hypot(e.x_mm, e.y_mm));
    }
    // A round factor; a perfect square, up to rounding, is not magnified.
    constexpr double kRoundingMm = 1e-6;
    magnification_ = 1.0;
    if (largest > kRoundingMm) {
      magnification_ =
          std::max(1.0, report::round_down_125(kLargestError * task.size_mm / largest));
    }
  }
  [[nodiscard]] double magnification() const { return magnification_; }
  [[nodiscard]] std::string commanded(std::size_t i) const { return at(square_.commanded[i]); }
  [[nodiscard]] std::string cut(std::size_t i) const {
    const BedPoint p = square_.commanded[i], e = error(i);
    return at({p.x_mm + magnification_ * e.x_mm, p.y_mm + magnification_ * e.y_mm});
  }

 private:
  [[nodiscard]] BedPoint error(std::size_t i) const {
    return {square_.cut[i].x_mm - square_.commanded[i].x_mm - square_.offset.x_mm,
            square_.cut[i].y_mm - square_.commanded[i].y_mm - square_.offset.y_mm};
  }
  [[nodiscard]] std::string at(BedPoint p) const {
    return fmt::format("{:.2f},{:.2f}",
                       kSquareLeft + scale_ * (p.x_mm - left_),
                       kSquareTop + scale_ * (top_ - p.y_mm));
  }

  const model::CutSquare& square_;
  double scale_, left_, top_, magnification_;
};

}  // namespace

std::string draw_square(const model::CutSquare& square, const SquareTask& task) {
  using model::SquareSide;
  const SquarePicture picture(square, task);
  std::string commanded, cut;
  for (std::size_t i = 0; i < square.cut.size(); ++i) {
    commanded += (i == 0 ? "" : " ") + picture.commanded(i);
    cut += (i == 0 ? "" : " ") + picture.cut(i);
  }
  const std::string title = fmt::format(
      "A {:g} mm square at ({:g}, {:g}) mm", task.size_mm, task.corner.x_mm, task.corner.y_mm);
  Svg svg(kWide, kHigh, "font-size=\"15\" fill=\"#222222\"", title);
  svg.fill();
  svg.add(
      "<polygon points=\"{0}\" fill=\"none\" stroke=\"#888888\" stroke-width=\"1.5\" "
      "stroke-dasharray=\"7 5\"/>\n"
      "<polygon points=\"{1}\" fill=\"{2}\" fill-opacity=\"0.08\" stroke=\"{2}\" "
      "stroke-width=\"2.5\" stroke-linejoin=\"round\"/>\n",
      commanded,
      cut,
      report::kAfterColor);
  const auto line = [&svg](double y, std::string_view words) {
    svg.text(kWide / 2, y, words, "middle");
  };
  line(34.0, title);
  line(58.0,
       fmt::format("dashed: commanded \u00b7 solid: cut, errors drawn {:g} times as large",
                   picture.magnification()));
  const auto side = [&square](SquareSide which) {
    const model::CutSide& s = square.side(which);
    return fmt::format("{:.2f} mm, bow {:+.2f}", s.length_mm, s.bow_mm);
  };
  const double middle_y = kSquareTop + kSide / 2;
  line(kSquareTop + 70.0, side(SquareSide::top));
  line(kSquareTop + kSide - 60.0, side(SquareSide::bottom));
  for (const auto& [which, x] : {std::pair(SquareSide::left, kSquareLeft + 70.0),
                                 std::pair(SquareSide::right, kSquareLeft + kSide - 60.0)}) {
    svg.text(x,
             middle_y,
             side(which),
             "middle",
             fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, middle_y));
  }
  line(kSquareTop + kSide + 90.0,
       fmt::format("diagonals: rising {:.2f} mm, falling {:.2f} mm (commanded {:.2f})",
                   square.rising_diagonal_mm,
                   square.falling_diagonal_mm,
                   task.size_mm * std::sqrt(2.0)));
  line(kSquareTop + kSide + 116.0,
       fmt::format("shifted by ({:+.2f}, {:+.2f}) mm and rotated by {:+.3f} mrad",
                   square.offset.x_mm,
                   square.offset.y_mm,
                   1e3 * square.rotation_rad));
  line(kSquareTop + kSide + 142.0,
       "bow: largest distance of a side from the line between its corners, + outwards");
  return svg.finished();
}

}  // namespace chaintrue::cli
