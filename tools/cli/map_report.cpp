// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_report.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "model/calibration/setting.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using grid::MapContents;
using grid::MapPoint;
using report::ErrorStep;

/// The error map's raster over the sheet: squares of some 60 mm on a full sheet.
constexpr int kColumns = 41;
constexpr int kRows = 21;

using Residual = Eigen::Vector2d MapPoint::*;

/// The tool beyond where the model thinks: the same arrow, seen from the drawing.
report::ToolVector tool_vector(const Eigen::Vector2d& residual_mm) {
  return {residual_mm.x(), residual_mm.y()};
}

/// Over the good points.
grid::ErrorSummary summary_of(const MapContents& contents, Residual residual) {
  grid::ErrorSummary summary;
  double squares_mm2 = 0.0;
  std::size_t good = 0;
  for (const MapPoint& point : contents.points) {
    if (point.bad) continue;
    const double error_mm = (point.*residual).norm();
    squares_mm2 += error_mm * error_mm;
    summary.maximum_mm = std::max(summary.maximum_mm, error_mm);
    ++good;
  }
  if (good > 0) summary.rms_mm = std::sqrt(squares_mm2 / static_cast<double>(good));
  return summary;
}

bool has_placed_sheet(const MapContents& contents) {
  return contents.settings.size() > std::size(model::kMachineSettings);
}

/// What the readings' noise amounts to at the tool, averaged over the points: the marks' own in x
/// and y, and the chains' carried to the tool.
double noise_at_tool_mm(const grid::CompensationMap& map) {
  const grid::MapNoise& noise = map.contents().noise;
  double variance_mm2 = 0.0;
  std::size_t count = 0;
  for (const MapPoint& point : map.contents().points) {
    const auto lengths = map.lengths(point.mark);
    if (point.bad || !lengths) continue;
    const Eigen::Matrix2d to_tool = lengths->mark_jacobian.inverse();
    // What was stated stands as it is; what was not is known only by the factor that was found.
    const double factor = noise.source == "stated" ? 1.0 : noise.factor_found;
    variance_mm2 += factor * factor *
                    (to_tool.squaredNorm() * noise.length_mm * noise.length_mm +
                     2.0 * noise.position_mm * noise.position_mm);
    ++count;
  }
  return count > 0 ? std::sqrt(variance_mm2 / static_cast<double>(count)) : 0.0;
}

/// The machine's bed; where there is no machine, the part that was measured.
report::Outline sheet_of(const grid::CompensationMap& map) {
  if (const model::Machine* machine = map.machine()) {
    const double half_width_mm = machine->bed.width_mm / 2,
                 half_height_mm = machine->bed.height_mm / 2;
    return {-half_width_mm, half_width_mm, -half_height_mm, half_height_mm};
  }
  const auto [left, right] = std::minmax_element(
      map.contents().hull.begin(), map.contents().hull.end(), [](const auto& a, const auto& b) {
        return a.x_mm < b.x_mm;
      });
  const auto [low, high] = std::minmax_element(
      map.contents().hull.begin(), map.contents().hull.end(), [](const auto& a, const auto& b) {
        return a.y_mm < b.y_mm;
      });
  return {left->x_mm, right->x_mm, low->y_mm, high->y_mm};
}

std::vector<report::ReportPoint> points_of(const grid::CompensationMap& map) {
  const MapContents& contents = map.contents();
  const Residual before =
      has_placed_sheet(contents) ? &MapPoint::sheet_placed_mm : &MapPoint::as_stated_mm;
  std::vector<report::ReportPoint> points;
  for (std::size_t i = 0; i < contents.points.size(); ++i) {
    const MapPoint& from = contents.points[i];
    report::ReportPoint point{
        .name = fmt::format("point {}", i + 1), .x_mm = from.mark.x_mm, .y_mm = from.mark.y_mm};
    if (map.machine() != nullptr) {
      point.before = tool_vector(from.*before);
      point.after = tool_vector(from.mapped_mm);
    }
    // Of holes no place is known but through the distances that the fit used.
    if (!contents.distances) {
      point.held_out = tool_vector(from.left_out_mm);
      point.held_out_sigmas = from.distance_sigmas;
    }
    point.is_bad = from.bad;
    points.push_back(std::move(point));
  }
  return points;
}

report::ErrorMap error_map_of(const grid::CompensationMap& map, const report::Outline& sheet) {
  report::ErrorMap raster{
      (sheet.x_max_mm - sheet.x_min_mm) / kColumns, (sheet.y_max_mm - sheet.y_min_mm) / kRows, {}};
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const model::MarkPoint at{sheet.x_min_mm + (column + 0.5) * raster.cell_width_mm,
                                sheet.y_min_mm + (row + 0.5) * raster.cell_height_mm};
      if (const auto answer = map.query(at)) {
        raster.cells.push_back(
            {at.x_mm, at.y_mm, answer->tool_sigma_mm, std::string(grid::name(answer->status))});
      }
    }
  }
  return raster;
}

std::vector<ErrorStep> steps_of(const grid::CompensationMap& map, double noise_mm) {
  const MapContents& contents = map.contents();
  std::vector<ErrorStep> steps;
  const auto add = [&steps](ErrorStep::Kind kind,
                            std::string what,
                            const grid::ErrorSummary& error,
                            std::string note) {
    steps.push_back({kind, std::move(what), error.rms_mm, error.maximum_mm, std::move(note)});
  };
  const bool has_machine = map.machine() != nullptr;
  if (has_machine) {
    add(ErrorStep::Kind::before,
        "machine as stated",
        summary_of(contents, &MapPoint::as_stated_mm),
        "at the measured points");
  }
  if (has_machine && has_placed_sheet(contents)) {
    add(ErrorStep::Kind::before,
        "sheet found",
        summary_of(contents, &MapPoint::sheet_placed_mm),
        "the same, with the sheet laid as well as it can be");
  }
  if (has_machine) {
    add(ErrorStep::Kind::after,
        "map, its own points",
        summary_of(contents, &MapPoint::mapped_mm),
        "what the fit leaves; too good to be promised");
  }
  if (contents.distances) {
    add(ErrorStep::Kind::after,
        "distances unseen",
        contents.distances->left_out_good,
        "each distance predicted by a fit without it, along the tape; contains the tape's noise");
  } else {
    add(ErrorStep::Kind::after,
        "map, unseen points",
        contents.accuracy.leave_one_out.tool,
        "each point predicted by a map made without it; contains that reading's noise");
    add(ErrorStep::Kind::after,
        "map, unseen regions",
        contents.accuracy.blocked.tool,
        "a block of the bed predicted by a map made without it");
  }
  if (noise_mm > 0.0) {
    steps.push_back(
        {ErrorStep::Kind::reference,
         "noise of a reading",
         noise_mm,
         {},
         fmt::format("{:.2g} mm a chain and {:.2g} mm a mark, {}",
                     contents.noise.length_mm,
                     contents.noise.position_mm,
                     contents.noise.source == "stated" ? "as stated"
                                                       : "found from " + contents.noise.source)});
  }
  add(ErrorStep::Kind::reference,
      "map, expected",
      contents.accuracy.expected_tool,
      "one sigma against the true machine, over the measured part");
  return steps;
}

std::vector<report::ReportSetting> settings_of(const grid::CompensationMap& map) {
  std::vector<report::ReportSetting> settings;
  for (const grid::SettingResult& result : map.contents().settings) {
    const auto in = [&result](double value) { return in_unit(result.setting, value); };
    const bool is_machine =
        std::find(model::kMachineSettings.begin(), model::kMachineSettings.end(), result.setting) !=
        model::kMachineSettings.end();
    settings.push_back(
        {.name = std::string(setting_in_words(result.setting)),
         .unit = std::string(unit_of(result.setting)),
         .stated = in(result.stated),
         .calibrated = in(result.calibrated),
         .sigma = in(result.sigma),
         .stated_sigma = is_machine ? in(stated_sigma(*map.machine(), result.setting)) : 0.0,
         .is_off = result.off});
  }
  return settings;
}

/// What to do now, the most urgent first.
std::vector<std::string> advice_of(const MapContents& contents,
                                   const model::Machine* machine,
                                   std::string_view source) {
  std::vector<std::string> advice;
  for (std::size_t i = 0; i < contents.points.size(); ++i) {
    const MapPoint& point = contents.points[i];
    if (!point.bad) continue;
    advice.push_back(
        fmt::format("Measure point {} at ({:.0f}, {:.0f}) again: it lies {:.1f} mm beside what its "
                    "neighbours say.",
                    i + 1,
                    point.mark.x_mm,
                    point.mark.y_mm,
                    point.left_out_mm.norm()));
  }
  for (const grid::SettingResult& result : contents.settings) {
    if (!result.off) continue;
    advice.push_back(
        fmt::format("Check \"{}\" with a tape: {:.1f} {} was stated, the points say {:.1f}.",
                    setting_in_words(result.setting),
                    in_unit(result.setting, result.stated),
                    unit_of(result.setting),
                    in_unit(result.setting, result.calibrated)));
  }
  if (machine != nullptr) {
    advice.push_back(fmt::format(
        "Now rewrite each program with it: chaintrue gcode compensate part.nc --map {0} -o "
        "part.true.nc.{1}",
        source,
        machine->controller.settings.motor_spacing_mm
            ? fmt::format(" Or type better numbers in, once: chaintrue export groundcontrol {}.",
                          source)
            : ""));
  }
  const grid::MapAccuracy& accuracy = contents.accuracy;
  advice.push_back(
      fmt::format("Expect {:.2f} mm (one sigma) over the measured part, and {:.2f} mm at its "
                  "weakest place, ({:.0f}, {:.0f}).",
                  accuracy.expected_tool.rms_mm,
                  accuracy.expected_tool.maximum_mm,
                  accuracy.expected_worst_at.x_mm,
                  accuracy.expected_worst_at.y_mm));
  return advice;
}

}  // namespace

report::MapReport map_report(const grid::CompensationMap& map, std::string_view source) {
  const MapContents& contents = map.contents();
  const grid::MapAccuracy& accuracy = contents.accuracy;
  const double noise_mm = noise_at_tool_mm(map);
  const bool is_clean = std::none_of(contents.points.begin(),
                                     contents.points.end(),
                                     [](const MapPoint& point) { return point.bad; }) &&
                        std::none_of(contents.settings.begin(),
                                     contents.settings.end(),
                                     [](const auto& setting) { return setting.off; });

  report::MapReport page;
  page.name = contents.name;
  page.machine_name = fmt::format("{}, {} points",
                                  map.machine() ? map.machine()->name : "no machine model",
                                  contents.points.size());
  page.sheet = sheet_of(map);
  page.verdict = fit_sentence(map);
  page.tone = is_clean ? report::Tone::good : report::Tone::caution;
  page.advice = advice_of(contents, map.machine(), source);
  page.not_proved =
      "These figures hold for the machine as it was when the points were measured. They do not say "
      "why it erred, and "
      "they end when a motor, a chain or the sheet is moved.";
  page.figures = {
      {fmt::format("{:.2f} mm", accuracy.leave_one_out.tool.rms_mm),
       contents.distances ? "rms of distances that the fit has not seen"
                          : "rms at points that the map has not seen"},
      {fmt::format("{:.2f} mm", accuracy.leave_one_out.tool.maximum_mm), "the worst of them"}};
  if (map.machine() != nullptr) {
    const Residual before =
        has_placed_sheet(contents) ? &MapPoint::sheet_placed_mm : &MapPoint::as_stated_mm;
    page.before_what = has_placed_sheet(contents) ? "the machine as stated, the sheet found"
                                                  : "the machine as stated";
    page.figures.push_back({fmt::format("{:.2f} mm", summary_of(contents, before).rms_mm),
                            "rms before: " + page.before_what});
  }
  page.figures.push_back({fmt::format("{:.2f} mm", accuracy.expected_tool.rms_mm),
                          "expected error of the map itself, one sigma"});
  page.steps = steps_of(map, noise_mm);
  page.points = points_of(map);
  page.error_map = error_map_of(map, page.sheet);
  page.held_out_rms_mm = accuracy.leave_one_out.tool.rms_mm;
  page.noise_floor_mm = noise_mm;
  page.settings = settings_of(map);
  if (contents.mirror) page.findings.push_back(contents.mirror->sentence);
  page.findings.insert(page.findings.end(), contents.notes.begin(), contents.notes.end());
  page.provenance = fmt::format("Made from {} by chaintrue {}.", source, CHAINTRUE_VERSION);
  return page;
}

}  // namespace chaintrue::cli
