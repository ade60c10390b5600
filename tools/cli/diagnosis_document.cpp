// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <algorithm>

#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/sheet.hpp"

namespace chaintrue::cli {

namespace {

/// A verdict at a glance.
struct VerdictLights {
  Tone tone;
  Tone found_tone;
  std::string_view found;
  Tone named_tone;
  std::string_view named;
};

constexpr VerdictLights kVerdicts[] = {
    {Tone::good, Tone::good, "yes", Tone::good, "yes, one cause"},
    {Tone::caution, Tone::good, "yes", Tone::caution, "one of a few"},
    {Tone::good, Tone::good, "yes", Tone::good, "yes, several together"},
    {Tone::bad, Tone::good, "yes, a pattern", Tone::bad, "no known cause"},
    {Tone::caution, Tone::caution, "readings, worse than entered", Tone::caution, "no cause"},
    {Tone::caution, Tone::caution, "bad points", Tone::caution, "no cause"},
    {Tone::good, Tone::good, "nothing hidden", Tone::good, "nothing to name"},
};  // by Verdict

/// In addition to the causes.
bool is_something_left(const Diagnosis& found) {
  if (found.belts) return found.unexplained && found.unexplained->probability > 0.5;
  return is_surprising(found.left_over);
}

Light data_light(const Diagnosis& found) {
  if (found.verdict == Verdict::named_set) {
    return {Tone::caution, "Enough data?",
            fmt::format("not to distinguish {} causes", found.causes.size())};
  }
  if (!found.not_testable.empty()) {
    return {Tone::caution, "Enough data?",
            found.not_testable.size() == 1
                ? "one cause could not be tested"
                : fmt::format("{} causes could not be tested", found.not_testable.size())};
  }
  return {Tone::good, "Enough data?", "yes"};
}

void put_the_verdict(const Diagnosis& found, Document& document) {
  const VerdictLights& lights = kVerdicts[as_size(found.verdict)];
  const bool left = is_something_left(found);
  // The error comes first, the same number as a fit begins with.
  document.verdict = {found.tool_today
                          ? fmt::format("Your machine misses by about {} mm. {}",
                                        about_mm(found.tool_today->rms_mm), found.sentence)
                          : found.sentence};
  // The bar's colour shows the machine's state, not the name's certainty: a worn chain is not good
  // news.
  const bool errs = left || !found.causes.empty() || !found.outliers.empty() ||
                    (found.drawing && drawn_settings_light(found).tone != Tone::good);
  document.tone = errs ? std::max(lights.tone, Tone::caution) : lights.tone;
  document.lights = {
      {lights.found_tone, "Found?", std::string(lights.found)},
      {left ? std::max(lights.named_tone, Tone::caution) : lights.named_tone, "Named?",
       fmt::format("{}{}", lights.named, left && !found.causes.empty() ? "; not all of it" : "")},
      data_light(found),
      found.belts     ? scale_light(found)
      : found.drawing ? drawn_settings_light(found)
                      : corrected_light(found)};
  document.figures = found.belts ? figures_of_belts(found) : figures_of_improvement(found);
  for (const std::string& line : found.what_to_do) document.advice.push_back({capitalised(line)});
  if (!found.not_proved.empty())
    document.not_proved = {"What this does not prove: " + found.not_proved};
}

/// Folded: the basis of the answer. On the page only: pictures.
enum Show { kOpen, kFolded, kOpenOnPage, kFoldedOnPage };

void add_sections(const Diagnosis& found, Detail detail, std::vector<Section>& sections) {
  const auto add = [&](Show show, bool has_any, SectionOf* section_of) {
    const bool is_of_page = show >= kOpenOnPage;
    if (!has_any || (is_of_page && detail != Detail::page)) return;
    Section& section = sections.emplace_back(section_of(found));
    if (is_of_page) section.detail = Detail::page;
    if (show == kFolded || show == kFoldedOnPage) section.is_folded = true;
  };
  const bool has_readings = !found.points.empty() || !found.distances.empty();
  const bool named = !found.causes.empty();
  add(kFolded, found.budget && !found.budget->lines.empty(), budget_section);
  add(kOpen, named, causes_section);
  add(kOpen, found.unexplained && !found.unexplained->laws.empty(), laws_section);
  add(kOpen, !found.declared.empty(), declared_section);
  add(kOpenOnPage, found.belts.has_value(), frame_section);
  add(kFolded, found.belts.has_value(), anchors_section);
  add(kOpen, found.drawing.has_value(), drawn_settings_section);
  add(kFolded, found.belts.has_value(), belts_improvement_section);
  // Without a cause to draw, the picture shows the errors.
  add(named ? kFoldedOnPage : kOpenOnPage, has_readings, arrows_section);
  add(kFoldedOnPage, has_readings && named, signature_section);
  add(kFolded, found.improvement.has_value(), improvement_section);
  add(kFolded, found.transferred.has_value(), transfer_section);
  add(kOpen, !found.next_measurements.empty(), next_section);
  add(kFoldedOnPage, has_readings, residuals_section);
  add(kFolded, !found.hypotheses.empty(), probabilities_section);
  // The section itself decides whether it is folded.
  add(kOpenOnPage, found.stability.has_value(), stability_section);
  add(kFolded, found.drawing.has_value(), drawn_measures_section);
  add(kFolded, !found.settings.empty(), settings_section);
  add(kFolded, !found.outliers.empty(), outliers_section);
  add(kFolded, !found.bounds.empty(), bounds_section);
  add(kFolded, !found.not_testable.empty(), not_testable_section);
}

const std::string& machine_name(const Diagnosis& found) {
  if (found.belts) return found.belts->machine.name;
  return found.drawing ? found.drawing->plotter : found.extended_machine.name;
}

}  // namespace

Document diagnosis_document(const Diagnosis& found, std::string_view source, Detail detail) {
  Document document;
  document.title = fmt::format("Diagnosis: {}", found.grid_name);
  document.subtitle = fmt::format("{}, {}", machine_name(found), readings_counted(found));
  put_the_verdict(found, document);
  add_sections(found, detail, document.sections);
  document.remarks = remarks_section(found);
  document.remarks.is_folded = true;
  document.has_glossary = true;
  document.provenance =
      fmt::format("Made from {} by chaintrue {}; seed {}.", source, CHAINTRUE_VERSION, found.seed);
  return document;
}

// The sections of a diagnosis on what to do, and what it does not cover.
namespace {

std::string_view where_it_goes(const Diagnosis& found) {
  constexpr std::string_view kGoes[] = {
      "Points go into the grid's file, readings into its \"readings\"",
      "Holes and distances go into the holes' file, readings into its \"readings\"",
      "Points go into the grid's file, holes and distances into the holes' file, readings into the "
      "\"readings\" of either",
      "Points and distances go into the belts' file",
      "Measures go into the drawing's file"};  // by Observations
  return kGoes[as_size(found.observations)];
}

std::string noise_in_words(const Diagnosis& found) {
  Words stated;
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

std::string outlier_in_words(const Diagnosis& found, const Outlier& bad) {
  if (bad.of == Observations::belts) return capitalised(bad_belt_in_words(bad));
  const bool is_drawn = bad.of == Observations::drawing;
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
  const Words sentences = follow_ups_in_words(found);
  List list{.is_numbered = true};
  for (const auto i : each_index(sentences))
    list.items.push_back({sentences[i] + chance_then(found, i)});
  Section section{fmt::format("What to measure next (chaintrue plan {} --after diagnosis.json)",
                              files_in_words(found)),
                  {std::move(list)}};
  section.say(fmt::format("Measure in this order; each probability includes all lines above it. "
                          "{}; the command prints the lines.",
                          where_it_goes(found)),
              Detail::page);
  const bool has_places = any_of(found.next_measurements, &NextMeasurement::mark);
  if (found.belts) return section;
  if (has_places && !is_of_distances(found)) section.blocks.emplace_back(next_points_chart(found));
  if (proposes(found, MeasurementKind::distance))
    section.blocks.emplace_back(next_distances_chart(found));
  return section;
}

Section settings_section(const Diagnosis& found) {
  const auto rows = mapped(found.settings, [](const auto& one) {
    return SettingRow{one.setting,    one.stated, one.stated_sigma,
                      one.calibrated, one.sigma,  one.off};
  });
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
    table.add({cause_title(bound.cause), bound_in_words(bound)});
  return {"Looked for, not found: anything larger would have shown", {std::move(table)}};
}

Section not_testable_section(const Diagnosis& found) {
  Table table{{{.width = 34}, {}}, {}, "They may be present or not."};
  for (const auto& missing : found.not_testable)
    table.add({cause_title(missing.cause), missing.reason});
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
