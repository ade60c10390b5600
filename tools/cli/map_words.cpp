// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "grid/precondition.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::cli {
namespace {

double rms(const grid::CompensationMap& map, Eigen::Vector2d grid::MapPoint::*residual) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const grid::MapPoint& point : map.contents().points) {
    if (point.bad) continue;
    squares += (point.*residual).squaredNorm();
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

void print_held_out(std::string& text, std::string_view name, const grid::HeldOutError& error) {
  fmt::format_to(std::back_inserter(text),
                 "  {:<28}{:>8.2f}{:>8.2f}{:>10.2f}{:>8.2f}\n",
                 name,
                 error.chain.rms_mm,
                 error.chain.maximum_mm,
                 error.tool.rms_mm,
                 error.tool.maximum_mm);
}

}  // namespace

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
        used.set_aside == 0 ? "" : fmt::format(" ({} more set aside)", used.set_aside));
  }
  const bool sheet = contents.settings.size() > std::size(model::kMachineSettings);
  return fmt::format(
      "With the settings as stated{} the tool was {:.2f} mm rms beside its {} points; the map "
      "leaves {:.2f} mm, and "
      "points that it has not seen come out within {:.2f} mm rms{}.",
      sheet ? " and the sheet laid as well as it can be" : "",
      rms(map, &grid::MapPoint::sheet_placed_mm),
      points,
      rms(map, &grid::MapPoint::mapped_mm),
      contents.accuracy.leave_one_out.tool.rms_mm,
      bad == 0 ? "" : fmt::format(" ({} set aside as bad)", bad));
}

std::string fit_in_words(const grid::CompensationMap& map) {
  const grid::MapContents& contents = map.contents();
  std::string text = fmt::format(
      "{}\nExpected error of the tool over the measured part (one sigma): {:.2f} mm rms, {:.2f} mm "
      "at "
      "worst, at ({:.0f}, {:.0f}).\n",
      fit_sentence(map),
      contents.accuracy.expected_tool.rms_mm,
      contents.accuracy.expected_tool.maximum_mm,
      contents.accuracy.expected_worst_at.x_mm,
      contents.accuracy.expected_worst_at.y_mm);
  for (const std::string& note : contents.notes) text += note + "\n";
  return text;
}

std::string fit_in_tables(const grid::CompensationMap& map) {
  const grid::MapContents& contents = map.contents();
  std::string text;
  if (!contents.settings.empty()) {
    report::Document settings;
    settings.sections.push_back({"", {settings_table(settings_rows(map))}});
    text += report::render_text(settings);
  }
  const bool direct = map.machine() == nullptr;
  if (contents.distances) {
    const grid::DistancesUsed& used = *contents.distances;
    fmt::format_to(std::back_inserter(text),
                   "\nError of distances left out one at a time, mm         rms     max\n"
                   "  {:<48}{:>8.2f}{:>8.2f}\n  {:<48}{:>8.2f}{:>8.2f}\n",
                   "all",
                   used.left_out_all.rms_mm,
                   used.left_out_all.maximum_mm,
                   "those that fit",
                   used.left_out_good.rms_mm,
                   used.left_out_good.maximum_mm);
  } else {
    text += "\nError of points left out, mm       chain rms     max  tool rms     max\n";
  }
  if (contents.distances) {
    // told above
  } else if (contents.accuracy.leave_one_out.tool.maximum_mm == 0.0) {
    text += "  not tested: no inner row or column could be left out\n";
  } else {
    print_held_out(text,
                   direct ? "a column or row at a time" : "one at a time",
                   contents.accuracy.leave_one_out);
    print_held_out(text,
                   direct ? "the worse of the two" : "a block of the bed at a time",
                   contents.accuracy.blocked);
  }
  if (contents.mirror) text += "\n" + contents.mirror->sentence + "\n";
  return text;
}

}  // namespace chaintrue::cli
