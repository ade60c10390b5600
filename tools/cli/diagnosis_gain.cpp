// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_gain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/diagnosis_charts.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Diagnosis;
using report::Cell;
using report::Detail;
using report::Light;
using report::Paragraph;
using report::Section;
using report::Table;
using report::Tone;

std::string border_sentence(const grid::diagnosis::Gain& gain) {
  const char* outermost = is_gain_of_distances(gain) ? "the distances that end at an outermost hole"
                                                     : "the outermost points";
  return gain.border.calibrated_mm > 0.0
             ? fmt::format("At the border {} were held out.", outermost)
             : fmt::format("No error at the border is given: without {} too few would be left.",
                           outermost);
}

std::vector<GainRow> transfer_rows(const grid::diagnosis::Diagnosis& diagnosis) {
  const grid::diagnosis::Transfer& transfer = *diagnosis.transferred;
  std::vector<GainRow> rows = {{"as delivered", &transfer.as_delivered, {}},
                               {"calibrated", &transfer.calibrated, {}}};
  if (!diagnosis.causes.empty()) {
    rows.push_back({"with the cause", &transfer.extended, {}});
    rows.push_back({"with the cause and a surface", &transfer.extended_and_surface, {}});
  } else {
    rows.push_back({"with a surface", &transfer.extended_and_surface, {}});
  }
  return rows;
}

Table error_table(const std::vector<GainRow>& rows, double floor_mm, std::string_view readings) {
  Table table{.columns = {{.page_heading = "model", .width = 32},
                          {.heading = "rms", .is_number = true, .page_heading = "rms, mm", .width = 7},
                          {.heading = "90 % interval", .is_number = true, .width = 15},
                          {.heading = "95 % of",
                           .is_number = true,
                           .page_heading = fmt::format("95 % of {} below", readings),
                           .width = 9}}};
  const bool has_border =
      std::any_of(rows.begin(), rows.end(), [](const GainRow& row) { return row.border_mm; });
  if (has_border) {
    table.columns.push_back({.heading = "border",
                             .is_number = true,
                             .page_heading = "at the border, rms",
                             .width = 9});
  }
  for (const GainRow& row : rows) {
    const grid::diagnosis::HeldOut& error = *row.held_out;
    table.rows.push_back({{row.what,
                           error.rms_mm,
                           fmt::format("{:.2f} to {:.2f}", error.low_mm, error.high_mm),
                           error.percentile_95_mm}});
    if (has_border) table.rows.back().cells.emplace_back(row.border_mm);
  }
  table.rows.push_back({{"noise of the readings", floor_mm}});
  return table;
}

}  // namespace

bool is_gain_of_distances(const grid::diagnosis::Gain& gain) {
  return gain.scheme.find("distances") != std::string::npos;
}

std::vector<GainRow> gain_rows(const grid::diagnosis::Diagnosis& diagnosis) {
  const grid::diagnosis::Gain& gain = *diagnosis.gain;
  std::vector<GainRow> rows = {{"as delivered", &gain.as_delivered, {}}};
  if (gain.placed) rows.push_back({"as delivered, sheet placed", &*gain.placed, {}});
  // Nothing was held out there where too few would have been left.
  const auto border = [&](double mm) {
    return gain.border.calibrated_mm > 0.0 ? std::optional(mm) : std::nullopt;
  };
  rows.push_back({"calibrated", &gain.calibrated, border(gain.border.calibrated_mm)});
  if (!diagnosis.causes.empty()) {
    rows.push_back({"with the cause", &gain.extended, border(gain.border.extended_mm)});
    rows.push_back({"with the cause and a surface",
                    &gain.extended_and_surface,
                    border(gain.border.extended_and_surface_mm)});
  }
  rows.push_back({"a surface only", &gain.surface_only, border(gain.border.surface_only_mm)});
  return rows;
}

Light corrected_light(const Diagnosis& found) {
  constexpr double kNearTheNoise = 1.25, kFarFromIt = 2.0;
  if (!found.gain) return {Tone::caution, "Corrected?", "not measured"};
  const double before_mm = found.gain->calibrated.rms_mm, after_mm = found.gain->extended.rms_mm;
  const double floor_mm = found.gain->noise_floor_mm;
  const Tone tone = after_mm <= kNearTheNoise * floor_mm ? Tone::good
                    : after_mm <= kFarFromIt * floor_mm  ? Tone::caution
                                                         : Tone::bad;
  return {tone,
          "Corrected?",
          found.causes.empty()
              ? fmt::format("{:.2f} mm, noise {:.2f}", after_mm, floor_mm)
              : fmt::format("{:.2f} to {:.2f} mm, noise {:.2f}", before_mm, after_mm, floor_mm)};
}

std::vector<report::Figure> figures_of_gain(const Diagnosis& found) {
  if (!found.gain) return {};
  const auto& gain = *found.gain;
  std::vector<report::Figure> figures = {
      {fmt::format("{:.2f} mm", gain.as_delivered.rms_mm), "rms as the machine was stated"}};
  if (gain.placed)
    figures.push_back({fmt::format("{:.2f} mm", gain.placed->rms_mm), "once the sheet is placed"});
  figures.push_back({fmt::format("{:.2f} mm", gain.calibrated.rms_mm), "with settings calibrated"});
  if (!found.causes.empty()) {
    figures.push_back({fmt::format("{:.2f} mm", gain.extended.rms_mm),
                       fmt::format("with the cause (90 %: {:.2f} to {:.2f})",
                                   gain.extended.low_mm,
                                   gain.extended.high_mm)});
  }
  figures.push_back({fmt::format("{:.2f} mm", gain.noise_floor_mm), "noise of the readings"});
  return figures;
}

Section gain_section(const Diagnosis& found) {
  const auto& gain = *found.gain;
  const bool of_distances = is_gain_of_distances(gain);
  const bool has_border = gain.border.calibrated_mm > 0.0;
  return {of_distances ? "Error of distances held out, mm"
                       : "Error of the tool at points held out, mm",
          {gain_chart(found),
           error_table(
               gain_rows(found), gain.noise_floor_mm, of_distances ? "distances" : "points"),
           Paragraph{fmt::format("{}; the same cause was named in {} of {} folds.",
                                 gain.scheme,
                                 gain.folds_agree,
                                 gain.folds)},
           Paragraph{border_sentence(gain), has_border ? Detail::page : Detail::always}}};
}

Section transfer_section(const Diagnosis& found) {
  const auto& other = *found.transferred;
  Table table = error_table(transfer_rows(found), other.noise_floor_mm, "points");
  table.caption =
      "Nothing was fitted to these points but, where the sheet was placed by hand, its place.";
  return {fmt::format("Error of the tool on \"{}\", {} points that had no part in this, mm",
                      other.to,
                      other.points),
          {std::move(table)}};
}

}  // namespace chaintrue::cli
