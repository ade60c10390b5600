// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/cli/belts_page.hpp"
#include "tools/cli/diagnosis_budget.hpp"
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_checks.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/distance_charts.hpp"
#include "tools/cli/follow_up.hpp"
#include "tools/report/glossary.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Cause;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;
using report::Light;
using report::Paragraph;
using report::Section;
using report::Table;
using report::Tone;

/// What a verdict looks like at a glance.
struct VerdictLights {
  Verdict verdict;
  Tone tone;
  Tone found_tone;
  std::string_view found;
  Tone named_tone;
  std::string_view named;
};

constexpr VerdictLights kVerdicts[] = {
    {Verdict::named, Tone::good, Tone::good, "yes", Tone::good, "yes, one cause"},
    {Verdict::named_set, Tone::caution, Tone::good, "yes", Tone::caution, "one of a few"},
    {Verdict::several_causes, Tone::good, Tone::good, "yes", Tone::good, "yes, several together"},
    {Verdict::model_discrepancy,
     Tone::bad,
     Tone::good,
     "yes, a pattern",
     Tone::bad,
     "no known cause"},
    {Verdict::noise_larger_than_stated,
     Tone::caution,
     Tone::caution,
     "noise, larger than stated",
     Tone::caution,
     "no cause"},
    {Verdict::outliers, Tone::caution, Tone::caution, "bad points", Tone::caution, "no cause"},
    {Verdict::nothing_found,
     Tone::good,
     Tone::good,
     "nothing hidden",
     Tone::good,
     "nothing to name"},
};

const VerdictLights& lights_of(Verdict verdict) {
  return *std::find_if(std::begin(kVerdicts), std::end(kVerdicts), [verdict](const auto& lights) {
    return lights.verdict == verdict;
  });
}

Light data_light(const Diagnosis& found) {
  if (found.verdict == Verdict::named_set) {
    return {Tone::caution,
            "Enough data?",
            fmt::format("not to tell {} causes apart", found.causes.size())};
  }
  if (!found.not_testable.empty()) {
    return {Tone::caution,
            "Enough data?",
            found.not_testable.size() == 1
                ? "one cause could not be tested"
                : fmt::format("{} causes could not be tested", found.not_testable.size())};
  }
  return {Tone::good, "Enough data?", "yes"};
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

std::vector<report::Figure> figures_of(const Diagnosis& found) {
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

Section arrows_section(const Diagnosis& found) {
  if (is_of_distances(found)) return {"What it does to the distances", {distance_chart(found)}};
  Section section{"What it does to the tool", {}};
  for (report::ChartRow& row : arrow_charts(found)) section.blocks.emplace_back(std::move(row));
  if (!found.distances.empty()) section.blocks.emplace_back(distance_chart(found));
  return section;
}

Section signature_section(const Diagnosis& found) {
  Section section{"Why this cause", {}};
  section.blocks.emplace_back(Paragraph{
      "What was measured beside what the cause makes of it, once the settings have taken what they "
      "can. A cause is right where its picture is the measured one and only noise is left."});
  for (report::Chart& chart : strip_charts(found)) section.blocks.emplace_back(std::move(chart));
  if (!found.distances.empty()) section.blocks.emplace_back(distance_strip_chart(found));
  return section;
}

Section residuals_section(const Diagnosis& found) {
  Section section{"What the error follows", {}};
  if (is_of_distances(found)) {
    section.blocks.emplace_back(distance_scatter_charts(found));
    section.blocks.emplace_back(Paragraph{
        "Distances know neither the chain's length at a hole nor in which order the holes were "
        "cut, so drift, skipped links and friction cannot be looked for."});
    return section;
  }
  for (report::ChartRow& row : length_charts(found)) section.blocks.emplace_back(std::move(row));
  section.blocks.emplace_back(angle_charts(found));
  if (has_order(found)) {
    section.blocks.emplace_back(order_charts(found));
  } else {
    section.blocks.emplace_back(Paragraph{
        "The points do not say in which order they were visited, so drift, skipped links and "
        "friction cannot be looked for."});
  }
  if (!found.distances.empty()) section.blocks.emplace_back(distance_scatter_charts(found));
  return section;
}

Section probabilities_section(const Diagnosis& found) {
  Section section{"How sure", {probability_chart(found)}};
  section.blocks.emplace_back(Paragraph{left_over_sentence(found.left_over)});
  return section;
}

Table error_table(const std::vector<GainRow>& rows,
                  double floor_mm,
                  bool has_border,
                  std::string_view readings) {
  Table table{{{"model"},
               {"rms, mm", true},
               {"90 % interval", true},
               {fmt::format("95 % of {} below", readings), true}},
              {},
              ""};
  if (has_border) table.columns.push_back({"at the border, rms", true});
  for (const GainRow& row : rows) {
    std::vector<std::string> cells = {
        std::string(row.what),
        fixed(row.held_out->rms_mm, 2),
        fmt::format("{:.2f} to {:.2f}", row.held_out->low_mm, row.held_out->high_mm),
        fixed(row.held_out->percentile_95_mm, 2)};
    if (has_border) cells.push_back(row.border_mm ? fixed(*row.border_mm, 2) : "\u2013");
    table.rows.push_back({std::move(cells), false});
  }
  table.rows.push_back({std::vector<std::string>(table.columns.size(), "\u2013"), false});
  table.rows.back().cells[0] = "noise of the readings";
  table.rows.back().cells[1] = fixed(floor_mm, 2);
  return table;
}

Section gain_section(const Diagnosis& found) {
  const auto& gain = *found.gain;
  Section section{"What naming it gains", {gain_chart(found)}};
  const bool of_distances = is_gain_of_distances(gain);
  const bool has_border = gain.border.calibrated_mm > 0.0;
  Table table = error_table(
      gain_rows(found), gain.noise_floor_mm, has_border, of_distances ? "distances" : "points");
  table.caption = fmt::format(
      "Error of {} that had no part in the fit: {}. The naming was repeated in "
      "every "
      "fold; {} of {} named the same. {}",
      of_distances ? "distances" : "the tool at points",
      gain.scheme,
      gain.folds_agree,
      gain.folds,
      border_sentence(gain));
  section.blocks.emplace_back(std::move(table));
  return section;
}

Section transfer_section(const Diagnosis& found) {
  const auto& other = *found.transferred;
  Table table = error_table(transfer_rows(found), other.noise_floor_mm, false, "points");
  table.caption =
      "Nothing was fitted to these points but, where the sheet was placed by hand, its place.";
  return {fmt::format("On other points: {} ({})", other.to, other.points), {std::move(table)}};
}

Section separation_section(const Diagnosis& found) {
  Section section{fmt::format("What these {} can tell apart", name(found.observations)),
                  {separation_chart(found)}};
  Table table{
      {{"cause"}, {"and"}, {"alike to", true}, {"told apart from a strength of", true}}, {}, ""};
  for (const auto& pair : found.separations) {
    table.rows.push_back(
        {{cause_title(pair.first),
          cause_title(pair.second),
          fixed(pair.collinearity, 3),
          std::isfinite(pair.signal_to_noise_needed) ? fixed(pair.signal_to_noise_needed, 1)
                                                     : "never"},
         false});
  }
  table.caption =
      "Strength in units of noise; at that strength 95 of 100 such machines are named right. The "
      "strengths found here are in the table of every cause.";
  section.blocks.emplace_back(std::move(table));
  return section;
}

Section next_section(const Diagnosis& found) {
  Section section = next_in_a_table(found);
  const bool has_places = std::any_of(found.next_measurements.begin(),
                                      found.next_measurements.end(),
                                      [](const auto& next) { return next.mark.has_value(); });
  if (has_places && !is_of_distances(found)) {
    section.blocks.emplace_back(next_points_chart(found));
  }
  if (proposes(found, grid::diagnosis::MeasurementKind::distance)) {
    section.blocks.emplace_back(next_distances_chart(found));
  }
  return section;
}

}  // namespace

report::Page diagnosis_page(const Diagnosis& found, std::string_view source) {
  if (found.belts) return belts_page(found, source);
  const VerdictLights& lights = lights_of(found.verdict);
  report::Page page;
  page.title = fmt::format("Diagnosis: {}", found.grid_name);
  page.subtitle = fmt::format("{}, {}", found.extended_machine.name, readings_counted(found));
  const bool has_readings = !found.points.empty() || !found.distances.empty();
  page.verdict = typeset(found.sentence);
  const bool is_something_left = is_surprising(found.left_over);
  // The bar tells how the machine is, not how sure the name: a worn chain is no good news.
  const bool errs = is_something_left || !found.causes.empty();
  page.tone = errs ? std::max(lights.tone, Tone::caution) : lights.tone;
  page.lights = {
      {lights.found_tone, "Found?", std::string(lights.found)},
      {is_something_left ? std::max(lights.named_tone, Tone::caution) : lights.named_tone,
       "Named?",
       fmt::format("{}{}",
                   lights.named,
                   is_something_left && !found.causes.empty() ? "; not all of it" : "")},
      data_light(found),
      corrected_light(found)};
  for (const std::string& line : found.what_to_do) page.advice.push_back(typeset(line));
  page.figures = figures_of(found);
  if (!found.not_proved.empty())
    page.not_proved = "What this does not prove: " + typeset(found.not_proved);
  if (found.budget && !found.budget->lines.empty()) page.sections.push_back(budget_section(found));
  if (found.trend) page.sections.push_back(trend_section(found));
  if (!found.causes.empty()) page.sections.push_back(causes_section(found));
  if (has_readings) page.sections.push_back(arrows_section(found));
  if (has_readings && !found.causes.empty()) page.sections.push_back(signature_section(found));
  if (found.gain) page.sections.push_back(gain_section(found));
  if (found.transferred) page.sections.push_back(transfer_section(found));
  if (!found.next_measurements.empty()) page.sections.push_back(next_section(found));
  if (has_readings) page.sections.push_back(residuals_section(found));
  if (!found.hypotheses.empty()) page.sections.push_back(probabilities_section(found));
  if (found.stability) page.sections.push_back(stability_section(found));
  if (waves_can_be_sought(found)) page.sections.push_back(waves_section(found));
  if (found.normal_plot) page.sections.push_back(normal_section(found));
  if (!found.terms.empty()) page.sections.push_back(terms_section(found));
  if (!found.separations.empty()) page.sections.push_back(separation_section(found));
  if (!found.outliers.empty()) page.sections.push_back(outliers_section(found));
  if (!found.bounds.empty() || !found.not_testable.empty())
    page.sections.push_back(bounds_section(found));
  if (!found.settings.empty()) page.sections.push_back(settings_section(found));
  page.sections.push_back(method_section(found));
  page.sections.push_back(report::glossary());
  page.provenance =
      fmt::format("Made from {} by chaintrue {}; seed {}.", source, CHAINTRUE_VERSION, found.seed);
  return page;
}

}  // namespace chaintrue::cli
