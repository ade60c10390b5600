// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a diagnosis on what to do, and what it does not cover.
#include <fmt/format.h>

#include "grid/containers.hpp"
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/follow_up.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

std::string_view where_it_goes(const Diagnosis& found) {
  constexpr std::string_view kGoes[] = {
      "Points go into the grid's file, readings into its \"readings\"",
      "Holes and distances go into the holes' file, readings into its \"readings\"",
      "Points go into the grid's file, holes and distances into the holes' file, readings into the "
      "\"readings\" of either",
      "Points and distances go into the belts' file",
      "Measures go into the drawing's file"};  // by Observations
  return kGoes[static_cast<std::size_t>(found.observations)];
}

std::string noise_in_words(const Diagnosis& found) {
  std::vector<std::string> stated;
  if (found.stated_noise) {
    stated.push_back(fmt::format(
        "{:g} mm per chain and {:g} mm per mark (one sigma, {:g} degrees of freedom); ",
        found.stated_noise->length_mm, found.stated_noise->position_mm, found.stated_noise->dof));
  }
  if (found.stated_tape) {
    stated.push_back(
        fmt::format("{:g} mm per tape reading and {:g} mm per hole on each axis (one sigma, {:g} "
                    "degrees of freedom); ",
                    found.stated_tape->tape_sigma_mm, found.stated_tape->hole_sigma_mm,
                    found.stated_tape->dof));
  }
  if (stated.empty()) return "The error of the readings is unknown; ";
  return fmt::format("Error of the readings, as entered: {}", fmt::join(stated, ""));
}

std::string outlier_in_words(const Diagnosis& found, const diagnosis::Outlier& bad) {
  if (bad.of == diagnosis::Observations::belts) return capitalised(bad_belt_in_words(bad));
  const bool is_drawn = bad.of == diagnosis::Observations::drawing;
  if (is_drawn || is_distance(found, bad)) {
    return fmt::format(
        "{}: read {} ({:.1f} sigmas)",
        is_drawn ? found.drawing->measures.at(bad.index).name : distance_name(found, bad.index),
        off_in_words(bad.residual_mm), bad.distance);
  }
  return fmt::format(
      "{}: fits only if the tool was {} mm right and {} mm up of its mark ({:.1f} sigmas)",
      point_name(bad.index), fixed(bad.shift_mm.x(), 2), fixed(bad.shift_mm.y(), 2), bad.distance);
}

}  // namespace

Section next_section(const Diagnosis& found) {
  const std::vector<std::string> sentences = follow_ups_in_words(found);
  List list{.is_numbered = true};
  for (std::size_t i = 0; i < sentences.size(); ++i)
    list.items.push_back({sentences[i] + chance_then(found, i)});
  Section section{fmt::format("What to measure next (chaintrue plan {} --after diagnosis.json)",
                              files_in_words(found)),
                  {std::move(list)}};
  section.say(fmt::format("Measure in this order; each probability includes all lines above it. "
                          "{}; the command prints the lines.",
                          where_it_goes(found)),
              Detail::page);
  const bool has_places =
      grid::any_of(found.next_measurements, [](const auto& next) { return next.mark.has_value(); });
  if (found.belts) return section;
  if (has_places && !is_of_distances(found)) section.blocks.emplace_back(next_points_chart(found));
  if (proposes(found, diagnosis::MeasurementKind::distance))
    section.blocks.emplace_back(next_distances_chart(found));
  return section;
}

Section settings_section(const Diagnosis& found) {
  std::vector<SettingRow> rows;
  for (const auto& one : found.settings)
    rows.push_back({one.setting, one.stated, one.stated_sigma, one.calibrated, one.sigma, one.off});
  return {"The machine's settings", {settings_table(rows)}};
}

Section outliers_section(const Diagnosis& found) {
  List list;
  for (const auto& bad : found.outliers) list.items.push_back({outlier_in_words(found, bad)});
  return {fmt::format("Bad {}: measure them again",
                      found.belts ? "readings" : name(found.observations)),
          {std::move(list), Paragraph{"They were left out.", Detail::page}}};
}

Section bounds_section(const Diagnosis& found) {
  Table table{{{.width = 34}, {}}, {}, "95 % bounds."};
  for (const auto& bound : found.bounds)
    table.rows.push_back({{cause_title(bound.cause), bound_in_words(bound)}});
  return {"Looked for, not found: anything larger would have shown", {std::move(table)}};
}

Section not_testable_section(const Diagnosis& found) {
  Table table{{{.width = 34}, {}}, {}, "They may be present or not."};
  for (const auto& missing : found.not_testable)
    table.rows.push_back({{cause_title(missing.cause), missing.reason}});
  return {"What these data cannot test", {std::move(table)}};
}

Section remarks_section(const Diagnosis& found) {
  Section section{"Basis of this answer"};
  for (const std::string& note : found.notes) section.say(note, Detail::always, true);
  if (found.belts) return section;
  section.say(noise_in_words(found) +
                  fmt::format("the estimated noise is {:.2f} times that.", found.noise_factor),
              Detail::page);
  for (const auto& correction : found.data_corrections) {
    section.say(
        fmt::format("Corrected in the data, not in the machine: {}.", cause_title(correction)),
        Detail::page);
  }
  return section;
}

}  // namespace chaintrue::cli
