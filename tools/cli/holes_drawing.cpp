// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/holes_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "tools/cli/holes_words.hpp"

namespace chaintrue::cli {
namespace {

using model::BedPoint;

// The picture, in its own units.
constexpr double kSheetWide = 900.0, kSheetLeft = 30.0, kSheetTop = 60.0, kSheetBelow = 50.0;

class Sheet {
 public:
  explicit Sheet(const model::Bed& bed) : bed_(bed), scale_(kSheetWide / bed.width_mm) {}
  [[nodiscard]] double x(BedPoint at) const {
    return kSheetLeft + scale_ * (at.x_mm + 0.5 * bed_.width_mm);
  }
  [[nodiscard]] double y(BedPoint at) const {
    return kSheetTop + scale_ * (0.5 * bed_.height_mm - at.y_mm);
  }
  [[nodiscard]] double bed_high() const { return scale_ * bed_.height_mm; }

 private:
  const model::Bed& bed_;
  double scale_;
};

/// Where labels go so that none lies on another, nor on a hole.
class Labels {
 public:
  struct Box {
    double left, right, top, bottom;
  };
  Labels(double left, double right) : left_(left), right_(right) {}

  void keep_free(double x, double y) {
    constexpr double kHole = 8.0;
    taken_.push_back({x - kHole, x + kHole, y - kHole, y + kHole});
  }
  /// The first of eight places about (x, y) that is free; the one that lies on least where none is.
  Box place(double x, double y, double wide) {
    constexpr double kHigh = 20.0, kGap = 10.0;
    Box best{};
    double least = -1.0;
    for (const double up : {-kGap, kGap + kHigh, 0.5 * kHigh}) {
      for (const double right : {kGap, -kGap - wide, -0.5 * wide}) {
        if (up == 0.5 * kHigh && right == -0.5 * wide) continue;
        const Box box{x + right, x + right + wide, y + up - kHigh, y + up};
        const double lies_on = overlap(box);
        if (least >= 0.0 && lies_on >= least) continue;
        least = lies_on;
        best = box;
      }
    }
    taken_.push_back(best);
    return best;
  }

 private:
  [[nodiscard]] double overlap(const Box& box) const {
    // Off the bed it would be cut at the picture's edge.
    double area = 20.0 * (std::max(0.0, left_ - box.left) + std::max(0.0, box.right - right_));
    for (const Box& other : taken_) {
      area += std::max(0.0, std::min(box.right, other.right) - std::max(box.left, other.left)) *
              std::max(0.0, std::min(box.bottom, other.bottom) - std::max(box.top, other.top));
    }
    return area;
  }

  double left_, right_;
  std::vector<Box> taken_;
};

/// The foot of the perpendicular on an edge of the bed.
BedPoint on_edge(BedPoint from, grid::SheetEdge edge, const model::Bed& bed) {
  switch (edge) {
    case grid::SheetEdge::left:
      return {-0.5 * bed.width_mm, from.y_mm};
    case grid::SheetEdge::right:
      return {0.5 * bed.width_mm, from.y_mm};
    case grid::SheetEdge::top:
      return {from.x_mm, 0.5 * bed.height_mm};
    case grid::SheetEdge::bottom:
      break;
  }
  return {from.x_mm, -0.5 * bed.height_mm};
}

}  // namespace

std::string draw_holes_plan(const grid::HolesPlan& plan) {
  const model::Bed& bed = plan.set.machine->bed;
  const Sheet sheet(bed);
  const bool has_edges =
      std::any_of(plan.set.distances.begin(), plan.set.distances.end(), [](const auto& distance) {
        return distance.edge.has_value();
      });
  const double wide = kSheetWide + 2.0 * kSheetLeft;
  const double high = kSheetTop + sheet.bed_high() + kSheetBelow;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 "
      "0 "
      "{0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"14\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      "<text x=\"{2:.0f}\" y=\"32\" font-size=\"18\">{3} holes, {4}: {5:.2f} mm expected at the "
      "tool "
      "(rms, one sigma)</text>\n"
      "<rect x=\"{2:.1f}\" y=\"{6:.1f}\" width=\"{7:.1f}\" height=\"{8:.1f}\" fill=\"#fff7ec\" "
      "stroke=\"#333333\"/>\n",
      wide,
      high,
      kSheetLeft,
      plan.set.holes.size(),
      distances_in_number(plan.set),
      plan.expected_rms_mm,
      kSheetTop,
      kSheetWide,
      sheet.bed_high());
  for (const grid::HoleDistance& distance : plan.set.distances) {
    const BedPoint from = plan.set.holes[distance.from].commanded;
    const BedPoint to =
        distance.edge ? on_edge(from, *distance.edge, bed) : plan.set.holes[distance.to].commanded;
    fmt::format_to(std::back_inserter(svg),
                   "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" "
                   "stroke=\"{}\" stroke-opacity=\"0.6\"><title>{}: about {:.0f} "
                   "mm</title></line>\n",
                   sheet.x(from),
                   sheet.y(from),
                   sheet.x(to),
                   sheet.y(to),
                   distance.edge ? "#009e73\" stroke-width=\"4" : "#0072b2",
                   words_of(plan.set, distance),
                   distance.distance_mm);
  }
  Labels labels(kSheetLeft, kSheetLeft + kSheetWide);
  for (const grid::Hole& hole : plan.set.holes)
    labels.keep_free(sheet.x(hole.commanded), sheet.y(hole.commanded));
  for (const grid::Hole& hole : plan.set.holes) {
    const double x = sheet.x(hole.commanded);
    const double y = sheet.y(hole.commanded);
    const std::string place =
        fmt::format("({:.0f}, {:.0f})", hole.commanded.x_mm + 0.0, hole.commanded.y_mm + 0.0);
    const Labels::Box box = labels.place(x, y, 18.0 + 7.5 * static_cast<double>(place.size()));
    fmt::format_to(std::back_inserter(svg),
                   "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\" fill=\"#ffffff\" "
                   "stroke=\"#d55e00\" stroke-width=\"3\"/>\n"
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" stroke=\"#fff7ec\" "
                   "stroke-width=\"4\" paint-order=\"stroke\"><tspan font-weight=\"bold\" "
                   "font-size=\"18\">{}</tspan> {}</text>\n",
                   x,
                   y,
                   box.left,
                   box.bottom - 3.0,
                   hole.name,
                   place);
  }
  fmt::format_to(
      std::back_inserter(svg),
      "<text x=\"{:.0f}\" y=\"{:.1f}\">Seen from the front; the origin is the middle of "
      "the bed. Each line is one reading of the tape, centre to centre{}.</text>\n</svg>\n",
      kSheetLeft,
      high - 18.0,
      has_edges ? "; green, square to an edge of the sheet" : "");
  return svg;
}

}  // namespace chaintrue::cli
