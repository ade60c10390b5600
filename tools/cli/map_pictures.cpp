// SPDX-License-Identifier: GPL-3.0-or-later
// The data of a compensation map's pictures.
#include <fmt/format.h>

#include <Eigen/LU>
#include <string>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/map/map_accuracy.hpp"
#include "tools/cli/map_document.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using grid::MapPoint;
using report::ErrorStep;

/// The error map's raster over the sheet: squares of some 60 mm on a full sheet.
constexpr int kColumns = 41;
constexpr int kRows = 21;

/// An arrow from where the model puts the tool to where it landed.
report::ToolVector tool_vector(const Eigen::Vector2d& residual_mm) {
  return {residual_mm.x(), residual_mm.y()};
}

/// The machine's bed; without a machine, the measured part.
report::Outline mapped_sheet(const CompensationMap& map) {
  if (const Machine* machine = map.machine()) {
    const double half_width_mm = machine->bed.width_mm / 2,
                 half_height_mm = machine->bed.height_mm / 2;
    return {-half_width_mm, half_width_mm, -half_height_mm, half_height_mm};
  }
  const auto [left, right] = grid::minmax_element(
      map.contents().hull, [](const auto& a, const auto& b) { return a.x_mm < b.x_mm; });
  const auto [low, high] = grid::minmax_element(
      map.contents().hull, [](const auto& a, const auto& b) { return a.y_mm < b.y_mm; });
  return {left->x_mm, right->x_mm, low->y_mm, high->y_mm};
}

std::vector<report::ReportPoint> points_of(const CompensationMap& map) {
  const MapContents& contents = map.contents();
  const Residual before = residual_before(contents);
  std::vector<report::ReportPoint> points;
  for (std::size_t i = 0; i < contents.points.size(); ++i) {
    const MapPoint& from = contents.points[i];
    report::ReportPoint point{
        .name = fmt::format("point {}", i + 1), .x_mm = from.mark.x_mm, .y_mm = from.mark.y_mm};
    if (map.machine() != nullptr) {
      point.before = tool_vector(from.*before);
      point.after = tool_vector(from.mapped_mm);
    }
    // The places of holes are known only through the distances used by the fit.
    if (!contents.distances) {
      point.held_out = tool_vector(from.left_out_mm);
      point.held_out_sigmas = from.distance_sigmas;
    }
    point.is_bad = from.bad;
    points.push_back(std::move(point));
  }
  return points;
}

report::ErrorMap error_map_of(const CompensationMap& map, const report::Outline& sheet) {
  report::ErrorMap raster{
      (sheet.x_max_mm - sheet.x_min_mm) / kColumns, (sheet.y_max_mm - sheet.y_min_mm) / kRows, {}};
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const MarkPoint at{sheet.x_min_mm + (column + 0.5) * raster.cell_width_mm,
                         sheet.y_min_mm + (row + 0.5) * raster.cell_height_mm};
      if (const auto answer = map.query(at)) {
        raster.cells.push_back(
            {at.x_mm, at.y_mm, answer->tool_sigma_mm, std::string(grid::name(answer->status))});
      }
    }
  }
  return raster;
}

std::vector<ErrorStep> steps_of(const CompensationMap& map, double noise_mm) {
  const MapContents& contents = map.contents();
  std::vector<ErrorStep> steps;
  const auto add = [&steps](ErrorStep::Kind kind, std::string what, const grid::ErrorSummary& error,
                            std::string note) {
    steps.push_back({kind, std::move(what), error.rms_mm, error.maximum_mm, std::move(note)});
  };
  const bool has_machine = map.machine() != nullptr;
  if (has_machine) {
    add(ErrorStep::Kind::before, "machine file as it was",
        summary_of(contents, &MapPoint::as_stated_mm), "at the measured points");
  }
  if (has_machine && has_placed_sheet(contents)) {
    add(ErrorStep::Kind::before, "sheet found", summary_of(contents, &MapPoint::sheet_placed_mm),
        "the same, for the best placement of the sheet");
  }
  if (has_machine) {
    add(ErrorStep::Kind::after, "map, its own points", summary_of(contents, &MapPoint::mapped_mm),
        "residual of the fit; not a measure of accuracy");
  }
  if (contents.distances) {
    add(ErrorStep::Kind::after, "distances left out", contents.distances->left_out_good,
        "each distance predicted by a fit without it, along the tape; includes the tape's noise");
  } else {
    add(ErrorStep::Kind::after, "map, points left out", contents.accuracy.leave_one_out.tool,
        "each point predicted by a map without it; includes that reading's noise");
    add(ErrorStep::Kind::after, "map, regions left out", contents.accuracy.blocked.tool,
        "a block of the bed predicted by a map without it");
  }
  if (noise_mm > 0.0) {
    steps.push_back({ErrorStep::Kind::reference,
                     "noise of a reading",
                     noise_mm,
                     {},
                     fmt::format("{:.2g} mm per chain and {:.2g} mm per mark, {}",
                                 contents.noise.length_mm, contents.noise.position_mm,
                                 contents.noise.source == grid::NoiseSource::stated
                                     ? std::string("as given")
                                     : fmt::format("found from {}", name(contents.noise.source)))});
  }
  add(ErrorStep::Kind::reference, "map, expected", contents.accuracy.expected_tool,
      "one sigma relative to the true machine, over the measured part");
  return steps;
}

}  // namespace

report::MapPictures map_pictures(const CompensationMap& map) {
  const double noise_mm = grid::noise_at_tool_mm(map);
  report::MapPictures pictures;
  pictures.sheet = mapped_sheet(map);
  pictures.before_what = machine_before(map.contents());
  pictures.steps = steps_of(map, noise_mm);
  pictures.points = points_of(map);
  pictures.error_map = error_map_of(map, pictures.sheet);
  pictures.held_out_rms_mm = map.contents().accuracy.leave_one_out.tool.rms_mm;
  pictures.noise_floor_mm = noise_mm;
  return pictures;
}

}  // namespace chaintrue::cli
