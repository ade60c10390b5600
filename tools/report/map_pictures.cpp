// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/map_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/report/typeset.hpp"

namespace chaintrue::report {
namespace {

using PointVector = std::optional<ToolVector> ReportPoint::*;

std::vector<Arrow> arrows_of(const MapPictures& report, PointVector vector) {
  std::vector<Arrow> arrows;
  for (const ReportPoint& point : report.points) {
    if (const auto& error = point.*vector)
      arrows.push_back(
          {point.name, point.x_mm, point.y_mm, error->x_mm, error->y_mm, point.is_bad});
  }
  return arrows;
}

Section before_after_section(const MapPictures& report, const std::vector<Arrow>& before,
                             const std::vector<Arrow>& after) {
  const std::vector<ChartRow> rows = arrow_rows(
      report.sheet, before, after,
      {"Before: " + report.before_what,
       "Each arrow points from the intended to the actual position of the tool. Hover over or tap "
       "a "
       "point for its values.",
       "After: with the map, same scale", "The residual at the points that the map was made from.",
       " Random directions are noise; neighbours that point the same way would mean an error that "
       "the map has missed."});
  return {"Before and after", {rows.begin(), rows.end()}};
}

Section steps_section(const MapPictures& report) {
  static constexpr const char* kColorOfKind[] = {kBeforeColor, kAfterColor, kNeutralColor};
  Chart chart{.specification = "error_steps", .title = "Error at the tool, rms"};
  DataTable steps{"steps", {"what", "rms_mm", "max_text", "color"}};
  Table table{{{"error of the tool"}, {"rms, mm", true}, {"worst, mm", true}, {"what it is"}}};
  for (const ErrorStep& step : report.steps) {
    steps.rows.push_back({step.what, step.rms_mm,
                          step.max_mm ? fixed(*step.max_mm, 2) + " mm" : "\u2013",
                          std::string(kColorOfKind[static_cast<std::size_t>(step.kind)])});
    table.rows.push_back({{step.what, step.rms_mm, step.max_mm, step.note}});
  }
  chart.data = {std::move(steps)};
  return {"Improvement with each step", {std::move(chart), std::move(table)}};
}

/// The points that were predicted from the others.
struct HeldOut {
  DataTable hits{"hits", {"name", "dx_mm", "dy_mm", "is_bad"}};
  DataTable points{"points", {"number", "name", "x_mm", "y_mm", "error_mm", "sigmas", "is_bad"}};
  double max_mm = 0.0;
  double max_of_good_mm = 0.0;
  bool has_bad = false;
};

HeldOut held_out_of(const MapPictures& report) {
  HeldOut result;
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const ReportPoint& point = report.points[i];
    if (!point.held_out) continue;
    const double error_mm = point.held_out->length_mm();
    result.max_mm = std::max(result.max_mm, error_mm);
    if (!point.is_bad) result.max_of_good_mm = std::max(result.max_of_good_mm, error_mm);
    result.has_bad |= point.is_bad;
    result.hits.rows.push_back(
        {point.name, point.held_out->x_mm, point.held_out->y_mm, point.is_bad});
    result.points.rows.push_back({static_cast<double>(i + 1), point.name, point.x_mm, point.y_mm,
                                  error_mm, point.held_out_sigmas, point.is_bad});
  }
  return result;
}

ChartRow held_out_charts(const MapPictures& report, const HeldOut& held_out) {
  const double rms_mm = report.held_out_rms_mm, noise_mm = report.noise_floor_mm;
  const std::vector<Value> rms = {rms_mm, fmt::format("rms {:.2f} mm", rms_mm), false};
  Chart target{
      .specification = "held_out_target",
      .title = "Each point predicted from the others",
      .caption =
          "Each dot is one point's error at the tool, as a hit on a target. A cloud around the "
          "middle is noise; a cloud off the middle would be a shift of the whole sheet.",
      .data = {held_out.hits, {"rings", {"radius_mm", "label", "is_dashed"}, {rms}}},
      .signals = {{"reach_mm", 1.15 * std::max({held_out.max_of_good_mm, rms_mm, 1e-3})}}};
  DataTable lines{"lines", {"value_mm", "label", "is_dashed"}, {rms}};
  if (noise_mm > 0.0)
    lines.rows.push_back(
        {noise_mm, fmt::format("noise of the readings {:.2f} mm", noise_mm), true});
  Chart one_by_one{
      .specification = "held_out_points",
      .title = "Point by point",
      .caption = "In the order of the file.",
      .data = {held_out.points, std::move(lines)},
      .signals = {{"top_mm", 1.08 * std::max({held_out.max_mm, rms_mm, noise_mm, 1e-3})}}};
  if (held_out.has_bad) {
    target.caption += " Crosses were left out; those off the target are drawn at its rim.";
    one_by_one.caption += " Points drawn as a cross were left out by the fit.";
  }
  return {{std::move(target), std::move(one_by_one)}};
}

}  // namespace

Chart error_map_chart(const MapPictures& report) {
  if (!report.error_map) throw std::invalid_argument("no error map to draw");
  const ErrorMap& map = *report.error_map;
  Chart chart{
      .specification = "error_map",
      .title = "Expected error over the bed",
      .caption = "One sigma at the tool, from the noise of the readings. Circles are the points."};
  DataTable cells{"cells", {"x_mm", "y_mm", "error_mm", "coverage"}};
  bool are_all_inside = true;
  for (const ErrorCell& cell : map.cells) {
    cells.rows.push_back({cell.x_mm, cell.y_mm, cell.error_mm, cell.coverage});
    are_all_inside &= cell.coverage == "inside";
  }
  if (!are_all_inside)
    chart.caption +=
        " Cells with a stroke are at or beyond the edge of the measured points and less reliable.";
  DataTable points{"points", {"x_mm", "y_mm"}};
  std::vector<Arrow> marks;
  for (const ReportPoint& point : report.points) {
    points.rows.push_back({point.x_mm, point.y_mm});
    marks.push_back({.x_mm = point.x_mm, .y_mm = point.y_mm});
  }
  chart.data = {std::move(cells), std::move(points)};
  chart.signals = bed_signals(report.sheet, marks);
  chart.signals.push_back({"cell_width_mm", map.cell_width_mm});
  chart.signals.push_back({"cell_height_mm", map.cell_height_mm});
  return chart;
}

std::vector<Section> picture_sections(const MapPictures& map) {
  std::vector<Section> sections;
  const auto before = arrows_of(map, &ReportPoint::before),
             after = arrows_of(map, &ReportPoint::after);
  if (!before.empty() && !after.empty())
    sections.push_back(before_after_section(map, before, after));
  if (!map.steps.empty()) sections.push_back(steps_section(map));
  if (map.error_map) sections.push_back({"Where to expect which error", {error_map_chart(map)}});
  if (const HeldOut held_out = held_out_of(map); !held_out.hits.rows.empty())
    sections.push_back({"How well it predicts", {held_out_charts(map, held_out)}});
  for (Section& section : sections) section.detail = Detail::page;
  return sections;
}

}  // namespace chaintrue::report
