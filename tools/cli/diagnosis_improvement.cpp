// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {
namespace {

/// A line of the table.
struct ImprovementRow {
  std::string_view what;
  const diagnosis::HeldOut* held_out = nullptr;
};

/// Distances were held out: no points were read, or too few.
bool is_improvement_of_distances(const diagnosis::HeldOutImprovement& improvement) {
  return improvement.scheme.find("distances") != std::string::npos;
}

/// Rows of an extension are left out where nothing was named.
std::vector<ImprovementRow> improvement_rows(const Diagnosis& diagnosis) {
  const diagnosis::HeldOutImprovement& improvement = *diagnosis.improvement;
  std::vector<ImprovementRow> rows = {
      {is_improvement_of_distances(improvement) ? "uncorrected" : "uncorrected, at these points",
       &improvement.uncalibrated}};
  if (improvement.placed) rows.push_back({"uncorrected, sheet placed", &*improvement.placed});
  rows.push_back({"calibrated", &improvement.calibrated});
  if (!diagnosis.causes.empty()) {
    rows.push_back({"with the cause", &improvement.extended});
    rows.push_back({"with the cause and a surface", &improvement.extended_and_surface});
  }
  rows.push_back({"a surface only", &improvement.surface_only});
  return rows;
}

std::vector<ImprovementRow> transfer_rows(const Diagnosis& diagnosis) {
  const diagnosis::Transfer& transfer = *diagnosis.transferred;
  std::vector<ImprovementRow> rows = {{"uncorrected, at these points", &transfer.uncalibrated},
                                      {"calibrated", &transfer.calibrated}};
  if (!diagnosis.causes.empty()) {
    rows.push_back({"with the cause", &transfer.extended});
    rows.push_back({"with the cause and a surface", &transfer.extended_and_surface});
  } else {
    rows.push_back({"with a surface", &transfer.extended_and_surface});
  }
  return rows;
}

Table error_table(const std::vector<ImprovementRow>& rows, double floor_mm,
                  std::string_view readings) {
  Table table{
      .columns = {{.page_heading = "model", .width = 32},
                  {.heading = "rms", .is_number = true, .page_heading = "rms, mm", .width = 7},
                  number_column("90 % interval", 15),
                  {.heading = "95 % of",
                   .is_number = true,
                   .page_heading = fmt::format("95 % of {} below", readings),
                   .width = 9}}};
  for (const ImprovementRow& row : rows) {
    const diagnosis::HeldOut& error = *row.held_out;
    table.add({row.what, error.rms_mm, fmt::format("{:.2f} to {:.2f}", error.low_mm, error.high_mm),
               error.percentile_95_mm});
  }
  table.add({"noise of the readings", floor_mm});
  return table;
}

Chart improvement_chart(const Diagnosis& found) {
  Chart chart{.specification = "gain_bars",
              .title = is_improvement_of_distances(*found.improvement)
                           ? "Error of distances left out, rms"
                           : "Error of the tool at points left out, rms",
              .caption = "The thin line on a bar is its 90 % interval. Left out: " +
                         found.improvement->scheme + "."};
  DataTable table{"rows", {"what", "rms_mm", "low_mm", "high_mm", "most_mm", "color"}};
  const auto color_of = [&](const diagnosis::HeldOut* row) {
    if (row == &found.improvement->extended || row == &found.improvement->extended_and_surface)
      return report::kAfterColor;
    return row == &found.improvement->surface_only ? report::kNeutralColor : report::kBeforeColor;
  };
  for (const ImprovementRow& row : improvement_rows(found)) {
    table.rows.push_back({std::string(row.what), row.held_out->rms_mm, row.held_out->low_mm,
                          row.held_out->high_mm, row.held_out->percentile_95_mm,
                          std::string(color_of(row.held_out))});
  }
  chart.data.push_back(std::move(table));
  chart.signals = {{"floor_mm", found.improvement->noise_floor_mm}};
  return chart;
}

}  // namespace

Light corrected_light(const Diagnosis& found) {
  constexpr double kNearTheNoise = 1.25, kFarFromIt = 2.0;
  if (!found.improvement) return {Tone::caution, "Corrected?", "not measured"};
  const double before_mm = found.improvement->calibrated.rms_mm,
               after_mm = found.improvement->extended.rms_mm;
  const double floor_mm = found.improvement->noise_floor_mm;
  const Tone tone = after_mm <= kNearTheNoise * floor_mm ? Tone::good
                    : after_mm <= kFarFromIt * floor_mm  ? Tone::caution
                                                         : Tone::bad;
  return {tone, "Corrected?",
          found.causes.empty()
              ? fmt::format("{:.2f} mm, noise {:.2f}", after_mm, floor_mm)
              : fmt::format("{:.2f} to {:.2f} mm, noise {:.2f}", before_mm, after_mm, floor_mm)};
}

std::vector<Figure> figures_of_improvement(const Diagnosis& found) {
  if (!found.improvement) return {};
  const auto& improvement = *found.improvement;
  std::vector<Figure> figures;
  if (found.tool_today) {
    figures.push_back({fmt::format("{} mm", about_mm(found.tool_today->rms_mm)), kToolTodayLabel});
  } else {
    figures.push_back({fmt::format("{:.2f} mm", improvement.uncalibrated.rms_mm),
                       "uncorrected, rms at these points"});
  }
  const char* left_out = is_improvement_of_distances(improvement) ? "rms of distances left out"
                                                                  : "rms at points left out";
  figures.push_back({fmt::format("{:.2f} mm", improvement.calibrated.rms_mm),
                     fmt::format("with settings calibrated, {}", left_out)});
  if (!found.causes.empty()) {
    figures.push_back({fmt::format("{:.2f} mm", improvement.extended.rms_mm),
                       fmt::format("with the cause (90 %: {:.2f} to {:.2f})",
                                   improvement.extended.low_mm, improvement.extended.high_mm)});
  }
  figures.push_back(
      {fmt::format("{:.2f} mm", improvement.noise_floor_mm), "noise of the readings"});
  return figures;
}

Section improvement_section(const Diagnosis& found) {
  const auto& improvement = *found.improvement;
  const bool of_distances = is_improvement_of_distances(improvement);
  return {
      of_distances ? "Error of distances left out, mm" : "Error of the tool at points left out, mm",
      {improvement_chart(found),
       error_table(improvement_rows(found), improvement.noise_floor_mm,
                   of_distances ? "distances" : "points"),
       Paragraph{fmt::format("{}; the same cause was named {} of {} times.", improvement.scheme,
                             improvement.folds_agree, improvement.folds)}}};
}

Section transfer_section(const Diagnosis& found) {
  const auto& other = *found.transferred;
  Table table = error_table(transfer_rows(found), other.noise_floor_mm, "points");
  table.caption = "Not fitted to these points, except for the placement of a hand-laid sheet.";
  return {fmt::format("Error of the tool on \"{}\", {} points not used here, mm", other.to,
                      other.points),
          {std::move(table)}};
}

}  // namespace chaintrue::cli
