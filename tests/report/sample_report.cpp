// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/report/sample_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tests/support/random.hpp"

namespace chaintrue::report::testing {
namespace {

constexpr double kBedWidthMm = 2438.4;
constexpr double kBedHeightMm = 1219.2;
constexpr double kNoiseMm = 0.15;

std::vector<ReportPoint> sample_points() {
  testing_support::Random random(20240607);
  std::vector<ReportPoint> points;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 7; ++column) {
      ReportPoint point;
      point.name = fmt::format("point {}", points.size() + 1);
      point.x_mm = -1100.0 + 2200.0 * column / 6 + 4.0 * random.normal();
      point.y_mm = -500.0 + 1000.0 * row / 3 + 4.0 * random.normal();
      const double u = point.x_mm / kBedWidthMm, v = point.y_mm / kBedHeightMm;
      const ToolVector after{kNoiseMm * random.normal(), kNoiseMm * random.normal()};
      point.after = after;
      point.before =
          ToolVector{6.0 * u - 2.0 * u * v + after.x_mm, 1.5 + 9.0 * u * u - 4.0 * v + after.y_mm};
      point.held_out = ToolVector{1.5 * after.x_mm + 0.05 * random.normal(),
                                  1.5 * after.y_mm + 0.05 * random.normal()};
      point.held_out_sigmas = std::hypot(after.x_mm, after.y_mm) / kNoiseMm;
      points.push_back(point);
    }
  }
  points[9].is_bad = true;
  points[9].held_out = ToolVector{1.2, -0.7};
  points[9].after = ToolVector{0.9, -0.6};
  return points;
}

ErrorMap sample_error_map() {
  ErrorMap map{kBedWidthMm / 33, kBedHeightMm / 17, {}};
  for (int row = 0; row < 17; ++row) {
    for (int column = 0; column < 33; ++column) {
      const double x_mm = -kBedWidthMm / 2 + (column + 0.5) * map.cell_width_mm;
      const double y_mm = -kBedHeightMm / 2 + (row + 0.5) * map.cell_height_mm;
      const double u = x_mm / kBedWidthMm, v = y_mm / kBedHeightMm;
      const bool is_inside = std::abs(x_mm) < 1100.0 && std::abs(y_mm) < 500.0;
      map.cells.push_back({x_mm, y_mm, 0.08 + 0.5 * u * u * u * u * 16 * 0.3 + 0.35 * v * v,
                           is_inside ? "inside" : "extrapolated"});
    }
  }
  return map;
}

}  // namespace

MapPictures sample_pictures() {
  MapPictures map;
  map.sheet = {-kBedWidthMm / 2, kBedWidthMm / 2, -kBedHeightMm / 2, kBedHeightMm / 2};
  map.steps = {
      {ErrorStep::Kind::before, "machine file as it was", 3.91, 6.2, "at the 28 points"},
      {ErrorStep::Kind::after, "machine calibrated", 0.44, 0.93, "points left out one at a time"},
      {ErrorStep::Kind::after, "with the map", 0.25, 0.52, "points left out one at a time"},
      {ErrorStep::Kind::reference,
       "noise of the readings",
       0.21,
       {},
       "as you said: 0.2 mm a chain, 0.3 mm a mark"}};
  map.points = sample_points();
  map.error_map = sample_error_map();
  map.held_out_rms_mm = 0.31;
  map.noise_floor_mm = 0.21;
  return map;
}

Document sample_document(const MapPictures& map) {
  Document document{.title = "Compensation map: workshop grid",
                    .subtitle = "classic Maslow, 28 points, sheet as placed"};
  document.verdict = {
      "Inside the measured points the tool will land within 0.25 mm (rms) of where the drawing "
      "says; with the machine file as it was it was 3.9 mm off."};
  document.advice = {
      {"Use this map for the whole sheet; near its lower corners expect up to 0.6 mm."},
      {"Measure point 10 again: it disagrees with its neighbours by 1.4 mm."}};
  document.not_proved = {"This says how well new points are predicted, not why the machine erred."};
  document.figures = {{"0.25 mm", "error to expect at the tool, rms, held out"},
                      {"0.52 mm", "worst point, held out"},
                      {"3.9 mm", "with the machine file as it was, rms"},
                      {"0.21 mm", "noise of the readings"}};
  document.sections = picture_sections(map);
  document.sections.push_back(
      {"The machine's settings",
       {Table{{{"setting"}, {"in the file", true}, {"calibrated", true}, {"unit"}, {"remark"}},
              {{{"left motor, x", -1489.2, -1492.31, "mm"}},
               {{"right motor, y", 1072.6, 1061.2, "mm", "off: check it"}, true},
               {{"sheet, turned", 0.0, 1.204, "mrad"}}},
              ""}}});
  document.remarks = {"What else was found",
                      {Paragraph{"The right chain does not mirror the left one: at mirrored points "
                                 "they differ by 4.2 mm (rms)."}}};
  document.has_glossary = true;
  document.provenance = "chaintrue, from grid.json.";
  return document;
}

}  // namespace chaintrue::report::testing
