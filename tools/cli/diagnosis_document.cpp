// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "tools/cli/diagnosis_sections.hpp"

#include <fmt/format.h>

#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::Verdict;

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
  const VerdictLights& lights = kVerdicts[static_cast<std::size_t>(found.verdict)];
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

}  // namespace chaintrue::cli
