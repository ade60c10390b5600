// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/statistics.hpp"
#include "tools/cli/svg.hpp"
#include "tools/report/hole_labels.hpp"

namespace chaintrue::cli {
namespace {

// The picture, in its own units.
constexpr double kBedWide = 900.0, kLeft = 30.0, kTop = 80.0, kBelow = 90.0;
constexpr double kBarWide = 300.0, kBarHigh = 14.0;
constexpr int kBarSteps = 30;

/// Light to dark, from the least expected error to the largest, so that grey prints are readable.
std::string colour(double share) {
  const auto mixed = [share](int light, int dark) {
    return std::lround(light + share * (dark - light));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", mixed(255, 179), mixed(247, 88), mixed(236, 6));
}

BedView view_of(const Bed& bed) { return {grid::area_of(bed), {kLeft, kTop}, kBedWide}; }

Svg begin(const BedView& view, std::string_view title, std::string_view description) {
  Svg svg(kBedWide + 2.0 * kLeft, kTop + view.high() + kBelow, "font-size=\"13\" fill=\"#222222\"",
          title);
  svg.add("<desc>{}</desc>\n", description);
  svg.fill();
  return svg;
}

/// A word next to a place, towards the middle of the bed, so that none is cut off at its edge.
void label(Svg& svg, const BedView& view, const MarkPoint& mark, double aside, double below,
           double above, std::string_view words) {
  const bool right_half = mark.x_mm > 0.0;
  svg.text(view.x(mark.x_mm) + (right_half ? -aside : aside),
           view.y(mark.y_mm) + (mark.y_mm > 0.0 ? below : above), words,
           right_half ? "end" : "start");
}

struct Shades {
  double least_mm = 0.0;
  double largest_mm = 0.0;
  std::string of(double error_mm) const {
    const double range = largest_mm - least_mm;
    return colour(range > 0.0 ? (error_mm - least_mm) / range : 0.0);
  }
};

Shades shades_of(const ExpectedErrors& errors) {
  Shades shades{errors.largest_mm, errors.largest_mm};
  for (double error : errors.cells_mm) {
    if (error >= 0.0) shades.least_mm = std::min(shades.least_mm, error);
  }
  return shades;
}

std::string filled(const std::string& colour) { return fmt::format("fill=\"{}\"", colour); }

void draw_errors(Svg& svg, const BedView& view, const ExpectedErrors& errors,
                 const Shades& shades) {
  const double wide = kBedWide / errors.columns;
  const double high = view.high() / errors.rows;
  std::size_t cell = 0;
  svg.add("<g shape-rendering=\"crispEdges\">\n");
  for (int row = 0; row < errors.rows; ++row) {
    for (int column = 0; column < errors.columns; ++column) {
      const double error = errors.cells_mm[cell++];
      svg.rectangle(kLeft + wide * column, kTop + high * (errors.rows - 1 - row), wide, high,
                    filled(error < 0.0 ? "#bbbbbb" : shades.of(error)));
    }
  }
  svg.add("</g>\n");
}

void draw_walk(Svg& svg, const BedView& view, const std::vector<MarkPoint>& marks) {
  Words corners;
  for (const MarkPoint& mark : marks)
    corners.push_back(fmt::format("{:.2f},{:.2f}", view.x(mark.x_mm), view.y(mark.y_mm)));
  svg.add(
      "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1\" stroke-opacity=\"0.6\" "
      "points=\"{}\"/>\n",
      report::kAfterColor, fmt::join(corners, " "));
  for (const auto i : each_index(marks)) {
    svg.circle(view.x(marks[i].x_mm), view.y(marks[i].y_mm), 4.0, filled(report::kAfterColor));
    label(svg, view, marks[i], 7.0, 15.0, -6.0, fmt::format("{}", i + 1));
  }
}

void draw_bar(Svg& svg, const BedView& view, const Shades& shades) {
  const double top = kTop + view.high() + kBelow - 55.0;
  for (int step = 0; step < kBarSteps; ++step) {
    svg.rectangle(kLeft + kBarWide * step / kBarSteps, top, kBarWide / kBarSteps + 0.5, kBarHigh,
                  filled(colour((step + 0.5) / kBarSteps)));
  }
  svg.text(kLeft, top + 32.0, fmt::format("{:.2f} mm", shades.least_mm));
  svg.text(kLeft + kBarWide, top + 32.0, fmt::format("{:.2f} mm", shades.largest_mm), "end");
  svg.text(kLeft + kBarWide + 20.0, top + 12.0,
           "expected error of the tool, one sigma; grey: the chains cannot hold the sled");
}

}  // namespace

ExpectedErrors expected_errors(const CompensationMap& map, const Bed& bed) {
  ExpectedErrors errors;
  errors.columns = 60;
  errors.rows = 30;
  errors.cells_mm = expected_error_mm(map, bed, errors.columns, errors.rows);
  const auto places =
      raster(grid::area_of(bed), errors.columns, errors.rows, grid::RasterOf::cells);
  const auto worst = max_element(errors.cells_mm);
  if (*worst > 0.0) {
    errors.largest_mm = *worst;
    errors.worst_at = places[as_size(worst - errors.cells_mm.begin())];
  }
  std::vector<double> answered_mm = errors.cells_mm;
  errors.unanswered = std::erase_if(answered_mm, [](double error) { return error < 0.0; });
  errors.rms_mm = grid::rms(answered_mm);
  return errors;
}

std::string draw_follow_up(const std::vector<MarkPoint>& measured,
                           const std::vector<FollowUpPlace>& next, const Bed& bed) {
  const BedView view = view_of(bed);
  const std::string words =
      fmt::format("{} places to measure next, among {} measured", next.size(), measured.size());
  Svg svg = begin(view, words, "The numbers are those of the list.");
  svg.text(kLeft, 32.0, words);
  svg.rectangle(kLeft, kTop, kBedWide, view.high(), "fill=\"#faf6ee\" stroke=\"#222222\"");
  for (const MarkPoint& mark : measured)
    svg.circle(view.x(mark.x_mm), view.y(mark.y_mm), 3.0, filled(report::kNeutralColor));
  for (const FollowUpPlace& place : next) {
    constexpr double kArm = 7.0;
    const double x = view.x(place.mark.x_mm), y = view.y(place.mark.y_mm);
    svg.path(fmt::format("M{0:.2f},{1:.2f}L{2:.2f},{3:.2f}M{0:.2f},{3:.2f}L{2:.2f},{1:.2f}",
                         x - kArm, y - kArm, x + kArm, y + kArm),
             fmt::format("stroke=\"{}\" stroke-width=\"2.5\"", report::kAfterColor));
    label(svg, view, place.mark, 10.0, 18.0, -9.0, place.numbers);
  }
  return svg.finished();
}

std::string draw_plan(const grid::MeasurementPlan& plan, const Bed& bed,
                      const ExpectedErrors& errors) {
  const BedView view = view_of(bed);
  const Shades shades = shades_of(errors);
  Svg svg = begin(view, fmt::format("{} points to measure", plan.marks.size()),
                  "The bed coloured by the expected error of a map from these points; the marks "
                  "are numbered in the order of measurement.");
  svg.text(
      kLeft, 32.0,
      fmt::format("{} points to measure: {} columns x {} rows{}", plan.marks.size(), plan.columns,
                  plan.rows, plan.extra > 0 ? fmt::format(" and {} more", plan.extra) : ""));
  svg.text(kLeft, 56.0,
           fmt::format("bed {:g} x {:g} mm, expected error {:.2f} mm rms, {:.2f} mm at most",
                       bed.width_mm, bed.height_mm, errors.rms_mm, errors.largest_mm));
  draw_errors(svg, view, errors, shades);
  svg.rectangle(kLeft, kTop, kBedWide, view.high(), "fill=\"none\" stroke=\"#222222\"");
  draw_walk(svg, view, plan.marks);
  draw_bar(svg, view, shades);
  return svg.finished();
}

namespace {

// The picture, in its own units.
constexpr double kSheetTop = 60.0, kSheetBelow = 50.0;

/// Each with its label, and a line from one to the other.
void draw_holes(const std::vector<Hole>& holes, const BedView& view, Svg& svg) {
  std::vector<report::DrawnHole> drawn;
  for (const Hole& hole : holes) {
    drawn.push_back(
        {view.x(hole.commanded.x_mm), view.y(hole.commanded.y_mm), hole.name,
         fmt::format("({:.0f}, {:.0f})", hole.commanded.x_mm + 0.0, hole.commanded.y_mm + 0.0)});
  }
  const std::vector<report::HoleLabel> labels = place_labels(drawn, kLeft, kLeft + kBedWide);
  for (const auto i : each_index(drawn)) {
    const report::DrawnHole& hole = drawn[i];
    const report::HoleLabel& label = labels[i];
    svg.add(
        R"(<line x1="{0:.1f}" y1="{1:.1f}" x2="{2:.1f}" y2="{3:.1f}" stroke="#333333"/>
<circle cx="{0:.1f}" cy="{1:.1f}" r="6" fill="#ffffff" stroke="{4}" stroke-width="3"/>
<text x="{5:.1f}" y="{6:.1f}" stroke="#fff7ec" stroke-width="4" paint-order="stroke"><tspan font-weight="bold" font-size="18">{7}</tspan>{8}{9}</text>
)",
        hole.x, hole.y, std::clamp(hole.x, label.left, label.right),
        std::clamp(hole.y, label.top, label.bottom), report::kBeforeColor, label.left,
        label.bottom - 3.0, hole.name, label.has_place ? " " : "",
        label.has_place ? hole.place : "");
  }
}

}  // namespace

BedPoint on_edge(BedPoint from, grid::SheetEdge edge, const Bed& bed) {
  const double x_mm = 0.5 * bed.width_mm, y_mm = 0.5 * bed.height_mm;
  const BedPoint feet[] = {{-x_mm, from.y_mm},
                           {x_mm, from.y_mm},
                           {from.x_mm, y_mm},
                           {from.x_mm, -y_mm}};  // by SheetEdge
  return feet[as_size(edge)];
}

std::string draw_holes_plan(const HolesPlan& plan) {
  const Bed& bed = plan.set.machine->bed;
  const BedView view{grid::area_of(bed), {kLeft, kSheetTop}, kBedWide};
  const bool has_edges = any_of(plan.set.distances, &grid::HoleDistance::edge);
  const double high = kSheetTop + view.high() + kSheetBelow;
  const std::string title =
      fmt::format("{} holes, {}: {:.2f} mm expected at the tool (rms, one sigma)",
                  plan.set.holes.size(), distances_in_number(plan.set), plan.expected_rms_mm);
  Svg svg(kBedWide + 2.0 * kLeft, high, "font-size=\"14\"", title);
  svg.fill();
  svg.text(kLeft, 32.0, title, "start", " font-size=\"18\"");
  svg.rectangle(kLeft, kSheetTop, kBedWide, view.high(), "fill=\"#fff7ec\" stroke=\"#333333\"");
  for (const grid::HoleDistance& distance : plan.set.distances) {
    const BedPoint from = plan.set.holes[distance.from].commanded;
    const BedPoint to =
        distance.edge ? on_edge(from, *distance.edge, bed) : plan.set.holes[distance.to].commanded;
    svg.add(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-opacity=\"0.6\"><title>{}: about {:.0f} mm</title></line>\n",
        view.x(from.x_mm), view.y(from.y_mm), view.x(to.x_mm), view.y(to.y_mm),
        distance.edge ? fmt::format("{}\" stroke-width=\"4", report::kThirdColor)
                      : std::string(report::kAfterColor),
        words_of(plan.set, distance), distance.distance_mm);
  }
  draw_holes(plan.set.holes, view, svg);
  svg.text(kLeft, high - 28.0, "From the front; the origin is the middle of the bed.");
  svg.text(kLeft, high - 10.0,
           fmt::format("Each line is one reading of the tape, centre to centre{}.",
                       has_edges ? "; green, square to an edge of the sheet" : ""));
  return svg.finished();
}

}  // namespace chaintrue::cli
