// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/square_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {
namespace {

// The picture, in its own units.
constexpr double kWide = 640.0, kHigh = 700.0, kSide = 400.0, kSquareLeft = 120.0, kSquareTop = 110.0;
constexpr double kLargestError = 0.11;  // share of the side that the largest error is drawn as

/// From the bed to the picture; the cut outline is drawn about its own middle, so that shape alone
/// shows.
class SquarePicture {
 public:
  SquarePicture(const model::CutSquare& square, const model::SquareTask& task)
      : square_(square),
        scale_(kSide / task.size_mm),
        left_(square.commanded.front().x_mm),
        top_(square.commanded.front().y_mm + task.size_mm) {
    double largest = 0.0;
    for (std::size_t i = 0; i < square.cut.size(); ++i) {
      const model::BedPoint e = error(i);
      largest = std::max(largest, std::hypot(e.x_mm, e.y_mm));
    }
    // A round number of times; a perfect square (rounding alone) is drawn as it is.
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
    const model::BedPoint p = square_.commanded[i], e = error(i);
    return at({p.x_mm + magnification_ * e.x_mm, p.y_mm + magnification_ * e.y_mm});
  }

 private:
  [[nodiscard]] model::BedPoint error(std::size_t i) const {
    return {square_.cut[i].x_mm - square_.commanded[i].x_mm - square_.offset.x_mm,
            square_.cut[i].y_mm - square_.commanded[i].y_mm - square_.offset.y_mm};
  }
  [[nodiscard]] std::string at(model::BedPoint p) const {
    return fmt::format(
        "{:.2f},{:.2f}", kSquareLeft + scale_ * (p.x_mm - left_), kSquareTop + scale_ * (top_ - p.y_mm));
  }

  const model::CutSquare& square_;
  double scale_, left_, top_, magnification_;
};

void write_text(std::string& svg,
                double x,
                double y,
                std::string_view anchor,
                std::string_view words,
                double turn_deg = 0.0) {
  const std::string turn =
      turn_deg == 0.0 ? ""
                      : fmt::format(" transform=\"rotate({:.0f} {:.1f} {:.1f})\"", turn_deg, x, y);
  fmt::format_to(std::back_inserter(svg),
                 "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n",
                 x,
                 y,
                 anchor,
                 turn,
                 words);
}

}  // namespace

std::string draw_square(const model::CutSquare& square, const model::SquareTask& task) {
  using model::SquareSide;
  const SquarePicture picture(square, task);
  std::string commanded, cut;
  for (std::size_t i = 0; i < square.cut.size(); ++i) {
    commanded += (i == 0 ? "" : " ") + picture.commanded(i);
    cut += (i == 0 ? "" : " ") + picture.cut(i);
  }
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"15\" fill=\"#222222\">\n"
      "<title>A {2:g} mm square at ({3:g}, {4:g}) mm</title>\n"
      "<desc>Dashed: as commanded. Solid: as cut, errors drawn {5:g} times as large.</desc>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      "<polygon points=\"{6}\" fill=\"none\" stroke=\"#888888\" stroke-width=\"1.5\" "
      "stroke-dasharray=\"7 5\"/>\n"
      "<polygon points=\"{7}\" fill=\"{8}\" fill-opacity=\"0.08\" stroke=\"{8}\" "
      "stroke-width=\"2.5\" "
      "stroke-linejoin=\"round\"/>\n",
      kWide,
      kHigh,
      task.size_mm,
      task.corner.x_mm,
      task.corner.y_mm,
      picture.magnification(),
      commanded,
      cut,
      report::kAfterColor);
  write_text(
      svg,
      kWide / 2,
      34.0,
      "middle",
      fmt::format(
          "A {:g} mm square at ({:g}, {:g}) mm", task.size_mm, task.corner.x_mm, task.corner.y_mm));
  write_text(svg,
             kWide / 2,
             58.0,
             "middle",
             fmt::format("dashed: commanded · solid: cut, errors drawn {:g} times as large",
                         picture.magnification()));
  const auto side = [&square](SquareSide which) {
    const model::CutSide& s = square.side(which);
    return fmt::format("{:.2f} mm, bow {:+.2f}", s.length_mm, s.bow_mm);
  };
  const double middle_x = kSquareLeft + kSide / 2, middle_y = kSquareTop + kSide / 2;
  write_text(svg, middle_x, kSquareTop + 70.0, "middle", side(SquareSide::top));
  write_text(svg, middle_x, kSquareTop + kSide - 60.0, "middle", side(SquareSide::bottom));
  write_text(svg, kSquareLeft + 70.0, middle_y, "middle", side(SquareSide::left), -90.0);
  write_text(svg, kSquareLeft + kSide - 60.0, middle_y, "middle", side(SquareSide::right), -90.0);
  write_text(svg,
             kWide / 2,
             kSquareTop + kSide + 90.0,
             "middle",
             fmt::format("diagonals: rising {:.2f} mm, falling {:.2f} mm (commanded {:.2f})",
                         square.rising_diagonal_mm,
                         square.falling_diagonal_mm,
                         task.size_mm * std::sqrt(2.0)));
  write_text(svg,
             kWide / 2,
             kSquareTop + kSide + 116.0,
             "middle",
             fmt::format("as a whole moved by ({:+.2f}, {:+.2f}) mm and turned by {:+.3f} mrad",
                         square.offset.x_mm,
                         square.offset.y_mm,
                         1e3 * square.rotation_rad));
  write_text(svg,
             kWide / 2,
             kSquareTop + kSide + 142.0,
             "middle",
             "bow: the farthest that a side leaves the line between its corners, + outwards");
  return svg + "</svg>\n";
}

}  // namespace chaintrue::cli
