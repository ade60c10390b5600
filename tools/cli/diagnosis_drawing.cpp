// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::cli {

using diagnosis::DrawnSetting;
using diagnosis::DrawnValue;

Section drawn_settings_section(const Diagnosis& found) {
  Table table{.columns = {{.heading = "setting", .width = 24},
                          {.heading = "as set", .is_number = true, .width = 10},
                          {.heading = "found", .is_number = true, .width = 10},
                          {.heading = "+-", .is_number = true, .width = 8},
                          {.heading = "", .gap = 2}}};
  for (const DrawnSetting& own : found.drawing->settings) {
    const auto words = diagnosis::parameter_words(own.name);
    Row row{{fmt::format("{}, {}", words.name, words.unit), own.set, own.found, own.sigma},
            own.off};
    if (own.off) row.cells.emplace_back("off");
    table.rows.push_back(std::move(row));
  }
  return {.title = "Settings of the plotter", .blocks = {std::move(table)}};
}

Section drawn_measures_section(const Diagnosis& found) {
  Table table{.columns = {{.heading = "measure, mm", .width = 24},
                          {.heading = "measured", .is_number = true, .width = 10},
                          {.heading = "explained", .is_number = true, .width = 11},
                          {.heading = "", .gap = 2}}};
  for (const DrawnValue& own : found.drawing->measures) {
    Row row{{own.name, own.measured_mm, own.explained_mm}, own.rejected};
    if (own.rejected) row.cells.emplace_back("left out");
    table.rows.push_back(std::move(row));
  }
  return {.title = "What was measured", .blocks = {std::move(table)}};
}

Light drawn_settings_light(const Diagnosis& found) {
  const auto& settings = found.drawing->settings;
  const auto off = std::count_if(
      settings.begin(), settings.end(), [](const DrawnSetting& own) { return own.off; });
  if (off == 0) return {Tone::good, "Settings right?", "yes"};
  return {Tone::caution, "Settings right?", fmt::format("{} off: type them in", off)};
}

}  // namespace chaintrue::cli
