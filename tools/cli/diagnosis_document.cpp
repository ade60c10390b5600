// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::Verdict;

/// A verdict at a glance.
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
     "readings, worse than entered",
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

/// In addition to the causes.
bool is_something_left(const Diagnosis& found) {
  if (found.belts) return found.unexplained && found.unexplained->probability > 0.5;
  return is_surprising(found.left_over);
}

Light data_light(const Diagnosis& found) {
  if (found.verdict == Verdict::named_set) {
    return {Tone::caution,
            "Enough data?",
            fmt::format("not to distinguish {} causes", found.causes.size())};
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

void put_the_verdict(const Diagnosis& found, Document& document) {
  const VerdictLights& lights = lights_of(found.verdict);
  const bool left = is_something_left(found);
  // The error comes first, the same number as a fit begins with.
  document.verdict = {found.tool_today ? fmt::format("Your machine misses by about {} mm. {}",
                                                     about_mm(found.tool_today->rms_mm),
                                                     found.sentence)
                                       : found.sentence};
  // The bar's colour shows the machine's state, not the name's certainty: a worn chain is not good
  // news.
  const bool errs = left || !found.causes.empty() || !found.outliers.empty() ||
                    (found.drawing && drawn_settings_light(found).tone != Tone::good);
  document.tone = errs ? std::max(lights.tone, Tone::caution) : lights.tone;
  document.lights = {
      {lights.found_tone, "Found?", std::string(lights.found)},
      {left ? std::max(lights.named_tone, Tone::caution) : lights.named_tone,
       "Named?",
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

/// Omits empty sections and, if no page is requested, those of the page. Folded: the basis of the
/// answer.
class Sections {
 public:
  Sections(std::vector<Section>& sections, Detail detail) : sections_(sections), detail_(detail) {}
  void add_open(bool has_any, Section (*section)(const Diagnosis&), const Diagnosis& found) {
    if (has_any) sections_.push_back(section(found));
  }
  void add(bool has_any, Section (*section)(const Diagnosis&), const Diagnosis& found) {
    add_open(has_any, section, found);
    if (has_any) sections_.back().is_folded = true;
  }
  void add_to_page(bool has_any, Section (*section)(const Diagnosis&), const Diagnosis& found) {
    add_open_to_page(has_any, section, found);
    if (has_any && detail_ == Detail::page) sections_.back().is_folded = true;
  }
  /// Folded as the section states.
  void add_open_to_page(bool has_any,
                        Section (*section)(const Diagnosis&),
                        const Diagnosis& found) {
    if (!has_any || detail_ != Detail::page) return;
    add_open(true, section, found);
    sections_.back().detail = Detail::page;
  }

 private:
  std::vector<Section>& sections_;
  Detail detail_;
};

void add_sections(const Diagnosis& found, Detail detail, std::vector<Section>& all) {
  const bool has_readings = !found.points.empty() || !found.distances.empty();
  const bool named = !found.causes.empty();
  Sections sections(all, detail);
  sections.add(found.budget && !found.budget->lines.empty(), budget_section, found);
  sections.add_open(named, causes_section, found);
  sections.add_open(found.unexplained && !found.unexplained->laws.empty(), laws_section, found);
  sections.add_open(!found.declared.empty(), declared_section, found);
  sections.add_open_to_page(found.belts.has_value(), frame_section, found);
  sections.add(found.belts.has_value(), anchors_section, found);
  sections.add_open(found.drawing.has_value(), drawn_settings_section, found);
  sections.add(found.belts.has_value(), belts_improvement_section, found);
  // Without a cause to draw, the picture shows the errors.
  if (named) {
    sections.add_to_page(has_readings, arrows_section, found);
  } else {
    sections.add_open_to_page(has_readings, arrows_section, found);
  }
  sections.add_to_page(has_readings && named, signature_section, found);
  sections.add(found.improvement.has_value(), improvement_section, found);
  sections.add(found.transferred.has_value(), transfer_section, found);
  sections.add_open(!found.next_measurements.empty(), next_section, found);
  sections.add_to_page(has_readings, residuals_section, found);
  sections.add(!found.hypotheses.empty(), probabilities_section, found);
  sections.add_open_to_page(found.stability.has_value(), stability_section, found);
  sections.add(found.drawing.has_value(), drawn_measures_section, found);
  sections.add(!found.settings.empty(), settings_section, found);
  sections.add(!found.outliers.empty(), outliers_section, found);
  sections.add(!found.bounds.empty(), bounds_section, found);
  sections.add(!found.not_testable.empty(), not_testable_section, found);
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
