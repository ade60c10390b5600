// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_improvement.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

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

Table error_table(const std::vector<ImprovementRow>& rows,
                  double floor_mm,
                  std::string_view readings) {
  Table table{
      .columns = {{.page_heading = "model", .width = 32},
                  {.heading = "rms", .is_number = true, .page_heading = "rms, mm", .width = 7},
                  {.heading = "90 % interval", .is_number = true, .width = 15},
                  {.heading = "95 % of",
                   .is_number = true,
                   .page_heading = fmt::format("95 % of {} below", readings),
                   .width = 9}}};
  for (const ImprovementRow& row : rows) {
    const diagnosis::HeldOut& error = *row.held_out;
    table.rows.push_back({{row.what,
                           error.rms_mm,
                           fmt::format("{:.2f} to {:.2f}", error.low_mm, error.high_mm),
                           error.percentile_95_mm}});
  }
  table.rows.push_back({{"noise of the readings", floor_mm}});
  return table;
}

}  // namespace

bool is_improvement_of_distances(const diagnosis::HeldOutImprovement& improvement) {
  return improvement.scheme.find("distances") != std::string::npos;
}

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

Light corrected_light(const Diagnosis& found) {
  constexpr double kNearTheNoise = 1.25, kFarFromIt = 2.0;
  if (!found.improvement) return {Tone::caution, "Corrected?", "not measured"};
  const double before_mm = found.improvement->calibrated.rms_mm,
               after_mm = found.improvement->extended.rms_mm;
  const double floor_mm = found.improvement->noise_floor_mm;
  const Tone tone = after_mm <= kNearTheNoise * floor_mm ? Tone::good
                    : after_mm <= kFarFromIt * floor_mm  ? Tone::caution
                                                         : Tone::bad;
  return {tone,
          "Corrected?",
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
                                   improvement.extended.low_mm,
                                   improvement.extended.high_mm)});
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
       error_table(improvement_rows(found),
                   improvement.noise_floor_mm,
                   of_distances ? "distances" : "points"),
       Paragraph{fmt::format("{}; the same cause was named {} of {} times.",
                             improvement.scheme,
                             improvement.folds_agree,
                             improvement.folds)}}};
}

Section transfer_section(const Diagnosis& found) {
  const auto& other = *found.transferred;
  Table table = error_table(transfer_rows(found), other.noise_floor_mm, "points");
  table.caption = "Not fitted to these points, except for the placement of a hand-laid sheet.";
  return {fmt::format(
              "Error of the tool on \"{}\", {} points not used here, mm", other.to, other.points),
          {std::move(table)}};
}

}  // namespace chaintrue::cli
