// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/holes_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "tools/cli/holes_words.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/hole_labels.hpp"

namespace chaintrue::cli {
namespace {

using model::BedPoint;

// The picture, in its own units.
constexpr double kSheetWide = 900.0, kSheetLeft = 30.0, kSheetTop = 60.0, kSheetBelow = 50.0;

class HolesSheet {
 public:
  explicit HolesSheet(const model::Bed& bed) : bed_(bed), scale_(kSheetWide / bed.width_mm) {}
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

/// Each with its label, and a line from one to the other.
void draw_holes(const std::vector<grid::Hole>& holes, const HolesSheet& sheet, std::string& svg) {
  std::vector<report::DrawnHole> drawn;
  for (const grid::Hole& hole : holes) {
    drawn.push_back(
        {sheet.x(hole.commanded),
         sheet.y(hole.commanded),
         hole.name,
         fmt::format("({:.0f}, {:.0f})", hole.commanded.x_mm + 0.0, hole.commanded.y_mm + 0.0)});
  }
  const std::vector<report::HoleLabel> labels =
      report::place_labels(drawn, kSheetLeft, kSheetLeft + kSheetWide);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const report::DrawnHole& hole = drawn[i];
    const report::HoleLabel& label = labels[i];
    fmt::format_to(std::back_inserter(svg),
                   "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{3:.1f}\" "
                   "stroke=\"#333333\"/>\n"
                   "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"6\" fill=\"#ffffff\" "
                   "stroke=\"{4}\" stroke-width=\"3\"/>\n"
                   "<text x=\"{5:.1f}\" y=\"{6:.1f}\" stroke=\"#fff7ec\" "
                   "stroke-width=\"4\" paint-order=\"stroke\"><tspan font-weight=\"bold\" "
                   "font-size=\"18\">{7}</tspan>{8}{9}</text>\n",
                   hole.x,
                   hole.y,
                   std::clamp(hole.x, label.left, label.right),
                   std::clamp(hole.y, label.top, label.bottom),
                   report::kBeforeColor,
                   label.left,
                   label.bottom - 3.0,
                   hole.name,
                   label.has_place ? " " : "",
                   label.has_place ? hole.place : "");
  }
}

}  // namespace

std::string draw_holes_plan(const grid::HolesPlan& plan) {
  const model::Bed& bed = plan.set.machine->bed;
  const HolesSheet sheet(bed);
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
                   distance.edge ? fmt::format("{}\" stroke-width=\"4", report::kThirdColor)
                                 : std::string(report::kAfterColor),
                   words_of(plan.set, distance),
                   distance.distance_mm);
  }
  draw_holes(plan.set.holes, sheet, svg);
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
