// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "model/calibration/setting.hpp"

namespace chaintrue::cli {

grid::ErrorSummary summary_of(const grid::MapContents& contents, Residual residual) {
  grid::ErrorSummary summary;
  double squares_mm2 = 0.0;
  std::size_t good = 0;
  for (const grid::MapPoint& point : contents.points) {
    if (point.bad) continue;
    const double error_mm = (point.*residual).norm();
    squares_mm2 += error_mm * error_mm;
    summary.maximum_mm = std::max(summary.maximum_mm, error_mm);
    ++good;
  }
  if (good > 0) summary.rms_mm = std::sqrt(squares_mm2 / static_cast<double>(good));
  return summary;
}

bool has_placed_sheet(const grid::MapContents& contents) {
  return contents.settings.size() > std::size(model::kMachineSettings);
}

Residual residual_before(const grid::MapContents& contents) {
  return has_placed_sheet(contents) ? &grid::MapPoint::sheet_placed_mm
                                    : &grid::MapPoint::as_stated_mm;
}

std::string_view machine_before(const grid::MapContents& contents) {
  return has_placed_sheet(contents) ? "the machine as stated, the sheet found"
                                    : "the machine as stated";
}

std::vector<SettingRow> settings_rows(const grid::CompensationMap& map) {
  std::vector<SettingRow> rows;
  for (const grid::SettingResult& result : map.contents().settings) {
    SettingRow row{
        result.setting, result.stated, {}, result.calibrated, result.sigma, result.off};
    const auto& of_machine = model::kMachineSettings;
    if (std::find(of_machine.begin(), of_machine.end(), result.setting) != of_machine.end())
      row.stated_sigma = stated_sigma(*map.machine(), result.setting);
    rows.push_back(row);
  }
  return rows;
}

std::string not_to_cut_with(const grid::CompensationMap& map) {
  // Machines that nobody calibrated are this far off, once their sheet is laid.
  constexpr double kMostMm = 3.0;
  const double left_out_mm = map.contents().accuracy.leave_one_out.tool.rms_mm;
  if (!(left_out_mm > kMostMm)) return {};
  return fmt::format("This map is not to be cut with: what it has not seen comes out {:.1f} mm rms "
                     "off, where {:g} mm are too much. Look at the points with the largest errors, "
                     "at the machine's measures and at its settings in force, and measure again.",
                     left_out_mm,
                     kMostMm);
}

bool refuses_to_cut_with(const grid::CompensationMap& map) {
  const std::string why = not_to_cut_with(map);
  if (why.empty()) return false;
  fmt::print(stderr, "{} --force goes on all the same.\n", why);
  return true;
}

std::string fit_sentence(const grid::CompensationMap& map) {
  const grid::MapContents& contents = map.contents();
  const auto bad = std::count_if(
      contents.points.begin(), contents.points.end(), [](const auto& p) { return p.bad; });
  const std::size_t points = contents.points.size();
  if (map.machine() == nullptr && contents.accuracy.leave_one_out.tool.maximum_mm == 0.0) {
    return fmt::format(
        "Splines through the lengths of {} points; too few rows and columns to leave one out, so "
        "their error was not tested.",
        points);
  }
  if (map.machine() == nullptr) {
    return fmt::format(
        "Splines through the lengths of {} points: left out a line at a time, points come back "
        "{:.2f} mm rms "
        "({:.2f} mm at worst) beside where they were measured.",
        points,
        contents.accuracy.leave_one_out.tool.rms_mm,
        contents.accuracy.leave_one_out.tool.maximum_mm);
  }
  if (contents.distances) {
    const grid::DistancesUsed& used = *contents.distances;
    return fmt::format(
        "{} distances between {} holes fit the calibrated machine: those that it has not seen come "
        "out within {:.2f} mm rms{}.",
        used.used,
        points,
        used.left_out_good.rms_mm,
        used.rejected == 0 ? "" : fmt::format(" ({} more set aside)", used.rejected));
  }
  const bool sheet = has_placed_sheet(contents);
  return fmt::format(
      "With the settings as stated{} the tool was {:.2f} mm rms beside its {} points; the map "
      "leaves {:.2f} mm, and "
      "points that it has not seen come out within {:.2f} mm rms{}.",
      sheet ? " and the sheet laid as well as it can be" : "",
      summary_of(contents, &grid::MapPoint::sheet_placed_mm).rms_mm,
      points,
      summary_of(contents, &grid::MapPoint::mapped_mm).rms_mm,
      contents.accuracy.leave_one_out.tool.rms_mm,
      bad == 0 ? "" : fmt::format(" ({} set aside as bad)", bad));
}

}  // namespace chaintrue::cli
