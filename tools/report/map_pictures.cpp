// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/map_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/report/typeset.hpp"

namespace chaintrue::report {
namespace {

double length_mm(const ToolVector& vector) { return std::hypot(vector.x_mm, vector.y_mm); }

using PointVector = std::optional<ToolVector> ReportPoint::*;

bool has_any(const MapPictures& report, PointVector vector) {
  return std::any_of(report.points.begin(), report.points.end(), [vector](const ReportPoint& p) {
    return (p.*vector).has_value();
  });
}

std::vector<Arrow> arrows_of(const MapPictures& report, PointVector vector) {
  std::vector<Arrow> arrows;
  for (const ReportPoint& point : report.points) {
    if (!(point.*vector)) continue;
    const ToolVector& error = *(point.*vector);
    arrows.push_back(
        {point.name, point.x_mm, point.y_mm, error.x_mm, error.y_mm, point.is_bad, 0.0, 0.0});
  }
  return arrows;
}

std::vector<Signal> signals_of_bed(const MapPictures& report) {
  std::vector<Arrow> marks;
  for (const ReportPoint& point : report.points)
    marks.push_back({.x_mm = point.x_mm, .y_mm = point.y_mm});
  return bed_signals(report.sheet, marks);
}

Section before_after_section(const MapPictures& report) {
  Section section{"Before and after", {}};
  for (ChartRow& row : arrow_rows(
           report.sheet,
           arrows_of(report, &ReportPoint::before),
           arrows_of(report, &ReportPoint::after),
           {"Before: " + report.before_what,
            "Each arrow points from the intended to the actual position of the tool. Hover over or "
            "tap a point for its values.",
            "After: with the map, same scale",
            "The residual at the points that the map was made from.",
            " Random directions are noise; neighbours that point the same way would mean an error "
            "that the map has missed."})) {
    section.blocks.emplace_back(std::move(row));
  }
  return section;
}

Section steps_section(const MapPictures& report) {
  static constexpr const char* kColorOfKind[] = {kBeforeColor, kAfterColor, kNeutralColor};
  Section section{"Improvement with each step", {}};
  Chart chart{.specification = "error_steps", .title = "Error at the tool, rms"};
  DataTable steps{"steps", {"what", "rms_mm", "max_text", "color"}, {}};
  Table table{
      {{"error of the tool"}, {"rms, mm", true}, {"worst, mm", true}, {"what it is"}}, {}, ""};
  for (const ErrorStep& step : report.steps) {
    const std::string worst = step.max_mm ? fixed(*step.max_mm, 2) : "\u2013";
    steps.rows.push_back({step.what,
                          step.rms_mm,
                          step.max_mm ? worst + " mm" : worst,
                          std::string(kColorOfKind[static_cast<std::size_t>(step.kind)])});
    table.rows.push_back({{step.what, step.rms_mm, step.max_mm, step.note}});
  }
  chart.data.push_back(std::move(steps));
  section.blocks.push_back(std::move(chart));
  section.blocks.push_back(std::move(table));
  return section;
}

struct HeldOut {
  double rms_mm = 0.0;
  double max_mm = 0.0;
  double max_of_good_mm = 0.0;
  std::size_t count = 0;
  bool has_bad = false;
};

/// Bad points count in max_mm and count only.
HeldOut held_out_of(const MapPictures& report) {
  HeldOut result;
  double sum_mm2 = 0.0;
  std::size_t good = 0;
  for (const ReportPoint& point : report.points) {
    if (!point.held_out) continue;
    const double error_mm = length_mm(*point.held_out);
    ++result.count;
    result.max_mm = std::max(result.max_mm, error_mm);
    if (point.is_bad) {
      result.has_bad = true;
      continue;
    }
    ++good;
    sum_mm2 += error_mm * error_mm;
    result.max_of_good_mm = std::max(result.max_of_good_mm, error_mm);
  }
  if (good > 0) result.rms_mm = std::sqrt(sum_mm2 / static_cast<double>(good));
  if (report.held_out_rms_mm > 0.0) result.rms_mm = report.held_out_rms_mm;
  return result;
}

Chart target_chart(const MapPictures& report, const HeldOut& held_out) {
  Chart chart{
      .specification = "held_out_target",
      .title = "Each point predicted from the others",
      .caption =
          "Each dot is one point's error at the tool, as a hit on a target. A cloud around the "
          "middle is noise; a cloud off the middle would be a shift of the whole sheet."};
  if (held_out.has_bad)
    chart.caption += " Crosses were left out; those off the target are drawn at its rim.";
  DataTable hits{"hits", {"name", "dx_mm", "dy_mm", "is_bad"}, {}};
  for (const ReportPoint& point : report.points) {
    if (point.held_out)
      hits.rows.push_back({point.name, point.held_out->x_mm, point.held_out->y_mm, point.is_bad});
  }
  DataTable rings{"rings", {"radius_mm", "label", "is_dashed"}, {}};
  rings.rows.push_back({held_out.rms_mm, fmt::format("rms {:.2f} mm", held_out.rms_mm), false});
  chart.data = {std::move(hits), std::move(rings)};
  chart.signals = {{"reach_mm", 1.15 * std::max({held_out.max_of_good_mm, held_out.rms_mm, 1e-3})}};
  return chart;
}

Chart points_chart(const MapPictures& report, const HeldOut& held_out) {
  Chart chart{.specification = "held_out_points",
              .title = "Point by point",
              .caption = "In the order of the file."};
  if (held_out.has_bad) chart.caption += " Points drawn as a cross were left out by the fit.";
  DataTable points{
      "points", {"number", "name", "x_mm", "y_mm", "error_mm", "sigmas", "is_bad"}, {}};
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const ReportPoint& point = report.points[i];
    if (!point.held_out) continue;
    points.rows.push_back({static_cast<double>(i + 1),
                           point.name,
                           point.x_mm,
                           point.y_mm,
                           length_mm(*point.held_out),
                           point.held_out_sigmas,
                           point.is_bad});
  }
  DataTable lines{"lines", {"value_mm", "label", "is_dashed"}, {}};
  lines.rows.push_back({held_out.rms_mm, fmt::format("rms {:.2f} mm", held_out.rms_mm), false});
  if (report.noise_floor_mm > 0.0) {
    lines.rows.push_back({report.noise_floor_mm,
                          fmt::format("noise of the readings {:.2f} mm", report.noise_floor_mm),
                          true});
  }
  chart.data = {std::move(points), std::move(lines)};
  chart.signals = {
      {"top_mm", 1.08 * std::max({held_out.max_mm, held_out.rms_mm, report.noise_floor_mm, 1e-3})}};
  return chart;
}

}  // namespace

Chart error_map_chart(const MapPictures& report) {
  if (!report.error_map) throw std::invalid_argument("no error map to draw");
  const ErrorMap& map = *report.error_map;
  Chart chart{
      .specification = "error_map",
      .title = "Expected error over the bed",
      .caption =
          "One sigma at the tool, from the noise of the readings. Circles are the points."};
  DataTable cells{"cells", {"x_mm", "y_mm", "error_mm", "coverage"}, {}};
  for (const ErrorCell& cell : map.cells)
    cells.rows.push_back({cell.x_mm, cell.y_mm, cell.error_mm, cell.coverage});
  if (std::any_of(map.cells.begin(), map.cells.end(), [](const ErrorCell& cell) {
        return cell.coverage != "inside";
      })) {
    chart.caption +=
        " Cells with a stroke are at or beyond the edge of the measured points and less reliable.";
  }
  DataTable points{"points", {"x_mm", "y_mm"}, {}};
  for (const ReportPoint& point : report.points) points.rows.push_back({point.x_mm, point.y_mm});
  chart.data.push_back(std::move(cells));
  chart.data.push_back(std::move(points));
  chart.signals = signals_of_bed(report);
  chart.signals.push_back({"cell_width_mm", map.cell_width_mm});
  chart.signals.push_back({"cell_height_mm", map.cell_height_mm});
  return chart;
}

std::vector<Section> picture_sections(const MapPictures& map) {
  std::vector<Section> sections;
  if (has_any(map, &ReportPoint::before) && has_any(map, &ReportPoint::after))
    sections.push_back(before_after_section(map));
  if (!map.steps.empty()) sections.push_back(steps_section(map));
  if (map.error_map) sections.push_back({"Where to expect which error", {error_map_chart(map)}});
  if (const HeldOut held_out = held_out_of(map); held_out.count > 0) {
    sections.push_back({"How well it predicts",
                        {ChartRow{{target_chart(map, held_out), points_chart(map, held_out)}}}});
  }
  for (Section& section : sections) section.detail = Detail::page;
  return sections;
}

}  // namespace chaintrue::report
