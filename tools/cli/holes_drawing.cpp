// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/holes_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "grid/containers.hpp"
#include "tools/cli/holes_words.hpp"
#include "tools/cli/svg.hpp"
#include "tools/report/hole_labels.hpp"

namespace chaintrue::cli {
namespace {

// The picture, in its own units.
constexpr double kSheetWide = 900.0, kSheetLeft = 30.0, kSheetTop = 60.0, kSheetBelow = 50.0;

/// The foot of the perpendicular on an edge of the bed.
BedPoint on_edge(BedPoint from, grid::SheetEdge edge, const Bed& bed) {
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
void draw_holes(const std::vector<grid::Hole>& holes, const BedView& view, Svg& svg) {
  std::vector<report::DrawnHole> drawn;
  for (const grid::Hole& hole : holes) {
    drawn.push_back(
        {view.x(hole.commanded.x_mm),
         view.y(hole.commanded.y_mm),
         hole.name,
         fmt::format("({:.0f}, {:.0f})", hole.commanded.x_mm + 0.0, hole.commanded.y_mm + 0.0)});
  }
  const std::vector<report::HoleLabel> labels =
      report::place_labels(drawn, kSheetLeft, kSheetLeft + kSheetWide);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const report::DrawnHole& hole = drawn[i];
    const report::HoleLabel& label = labels[i];
    svg.add(
        "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{3:.1f}\" stroke=\"#333333\"/>\n"
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"6\" fill=\"#ffffff\" stroke=\"{4}\" "
        "stroke-width=\"3\"/>\n"
        "<text x=\"{5:.1f}\" y=\"{6:.1f}\" stroke=\"#fff7ec\" stroke-width=\"4\" "
        "paint-order=\"stroke\"><tspan font-weight=\"bold\" "
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
  const Bed& bed = plan.set.machine->bed;
  const BedView view(bed.width_mm, bed.height_mm, {kSheetLeft, kSheetTop}, kSheetWide);
  const bool has_edges = grid::any_of(
      plan.set.distances, [](const auto& distance) { return distance.edge.has_value(); });
  const double high = kSheetTop + view.high() + kSheetBelow;
  const std::string title =
      fmt::format("{} holes, {}: {:.2f} mm expected at the tool (rms, one sigma)",
                  plan.set.holes.size(),
                  distances_in_number(plan.set),
                  plan.expected_rms_mm);
  Svg svg(kSheetWide + 2.0 * kSheetLeft, high, "font-size=\"14\"", title);
  svg.fill();
  svg.text(kSheetLeft, 32.0, title, "start", " font-size=\"18\"");
  svg.rectangle(
      kSheetLeft, kSheetTop, kSheetWide, view.high(), "fill=\"#fff7ec\" stroke=\"#333333\"");
  for (const grid::HoleDistance& distance : plan.set.distances) {
    const BedPoint from = plan.set.holes[distance.from].commanded;
    const BedPoint to =
        distance.edge ? on_edge(from, *distance.edge, bed) : plan.set.holes[distance.to].commanded;
    svg.add(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-opacity=\"0.6\"><title>{}: about {:.0f} mm</title></line>\n",
        view.x(from.x_mm),
        view.y(from.y_mm),
        view.x(to.x_mm),
        view.y(to.y_mm),
        distance.edge ? fmt::format("{}\" stroke-width=\"4", report::kThirdColor)
                      : std::string(report::kAfterColor),
        words_of(plan.set, distance),
        distance.distance_mm);
  }
  draw_holes(plan.set.holes, view, svg);
  svg.text(kSheetLeft, high - 28.0, "From the front; the origin is the middle of the bed.");
  svg.text(kSheetLeft,
           high - 10.0,
           fmt::format("Each line is one reading of the tape, centre to centre{}.",
                       has_edges ? "; green, square to an edge of the sheet" : ""));
  return svg.finished();
}

}  // namespace chaintrue::cli
