// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/belts_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/cli/belts_frame_chart.hpp"
#include "tools/cli/belts_words.hpp"
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_checks.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/glossary.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::BeltPlacePicture;
using grid::diagnosis::BeltsFindings;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;
using model::Belt;
using model::kBelts;
using report::Chart;
using report::DataTable;
using report::Light;
using report::Paragraph;
using report::Section;
using report::Table;
using report::Tone;

Section frame_section(const Diagnosis& found) {
  const BeltsFindings& belts = *found.belts;
  Chart before = frame_chart(belts, "Anchors alone", &BeltPlacePicture::before_mm);
  before.caption = kFrameCaption;
  Section section{"The frame, and what its belts disagree about", {}};
  if (found.causes.empty()) {
    section.blocks.emplace_back(std::move(before));
    return section;
  }
  Chart after = frame_chart(belts,
                            found.causes.size() > 1 ? "With the causes" : "With the cause",
                            &BeltPlacePicture::after_mm);
  after.caption = "The same scale. Strokes that point all ways are noise.";
  section.blocks.emplace_back(std::move(before));
  section.blocks.emplace_back(std::move(after));
  return section;
}

Section numbers_section(const Diagnosis& found) {
  const BeltsFindings& belts = *found.belts;
  Table table{{{"mm"}, {"anchors alone", true}, {"with what is named", true}}, {}, ""};
  const auto row = [&table](const char* what, double before, double after) {
    table.rows.push_back({{what, fixed(before, 2), fixed(after, 2)}, false});
  };
  row("one belt's reading is off by", belts.spread_before_mm, belts.spread_mm);
  row("rms over all readings, as the machine counts", belts.rms_before_mm, belts.rms_mm);
  if (belts.foretold && belts.foretold_before) {
    row("lower belts, foretold at places left out",
        belts.foretold_before->rms_mm,
        belts.foretold->rms_mm);
  }
  row("the tool, over the measured places", belts.tool.before_mm, belts.tool.after_mm);
  table.caption =
      belts.tool.scale_mm_per_m
          ? fmt::format("The tool's error leaves the frame's place and turn free; the tape leaves "
                        "{:.2f} mm in a metre of the scale open.",
                        *belts.tool.scale_mm_per_m)
          : "The tool's error leaves the frame's place and turn free, and is in the belts' own "
            "millimetres: how long these are no belt knows.";
  Section section{"What naming it gains", {std::move(table)}};
  for (const std::string& note : found.notes) {
    if (note.find("Find Anchors fit") != std::string::npos)
      section.blocks.emplace_back(Paragraph{typeset(note)});
  }
  return section;
}

Section anchors_section(const Diagnosis& found) {
  Table table{{{"anchor"},
               {"stated, mm", true},
               {"alone, mm", true},
               {"with what is named, mm", true},
               {"\u00b1", true}},
              {},
              "From the bottom left anchor, x to the bottom right one; \u00b1: one sigma."};
  for (const auto& c : found.belts->coordinates) {
    const auto belt = model::belt_of(c.name.substr(0, 2));
    table.rows.push_back({{fmt::format("{} {}", belt ? model::words(*belt) : "", c.name.substr(3, 1)),
                           c.stated_mm ? fixed(*c.stated_mm, 1) : "\u2013",
                           fixed(c.before_mm, 2),
                           fixed(c.fitted_mm, 2),
                           fixed(c.sigma_mm, 2)},
                          false});
  }
  return {"The anchors", {std::move(table)}};
}

Section bad_section(const Diagnosis& found) {
  Table table{{{"reading"}}, {}, "They were set aside; let the machine measure there again."};
  for (const auto& bad : found.outliers)
    table.rows.push_back({{capitalised(bad_belt_in_words(bad))}, true});
  return {"Bad readings", {std::move(table)}};
}

std::vector<Light> lights_of(const Diagnosis& found) {
  const bool named = !found.causes.empty();
  const bool one_of = found.verdict == Verdict::named_set;
  const bool left = found.unexplained && found.unexplained->probability > 0.5;
  std::vector<Light> lights;
  lights.push_back({Tone::good,
                    "Found?",
                    named                    ? "yes"
                    : !found.outliers.empty() ? "bad readings"
                    : left                    ? "yes, a pattern"
                                              : "nothing hidden"});
  lights.push_back({one_of || (left && !named) ? Tone::caution : Tone::good,
                    "Named?",
                    one_of   ? "one of a few"
                    : named  ? (left ? "yes; not all of it" : "yes")
                    : left   ? "no known cause"
                             : "nothing to name"});
  lights.push_back({found.belts->scale ? Tone::good : Tone::caution,
                    "Scale known?",
                    found.belts->scale ? "yes, by the tape" : "not without a tape"});
  return lights;
}

}  // namespace

report::Page belts_page(const Diagnosis& found, std::string_view source) {
  const BeltsFindings& belts = *found.belts;
  report::Page page;
  page.title = fmt::format("Diagnosis: {}", found.grid_name);
  page.subtitle = fmt::format("{}, {}", belts.machine.name, readings_counted(found));
  page.verdict = typeset(found.sentence);
  page.tone = found.causes.empty() && found.outliers.empty() ? Tone::good : Tone::caution;
  page.lights = lights_of(found);
  for (const std::string& line : found.what_to_do) page.advice.push_back(typeset(line));
  page.figures = {
      {fmt::format("{:.2f} mm", belts.spread_before_mm), "one belt is off by, anchors alone"},
      {fmt::format("{:.2f} mm", belts.spread_mm), "with what is named"}};
  if (!found.not_proved.empty())
    page.not_proved = "What this does not prove: " + typeset(found.not_proved);
  if (!found.causes.empty()) page.sections.push_back(causes_section(found));
  page.sections.push_back(frame_section(found));
  page.sections.push_back(numbers_section(found));
  page.sections.push_back(anchors_section(found));
  if (!found.next_measurements.empty()) page.sections.push_back(next_in_a_table(found));
  if (!found.hypotheses.empty())
    page.sections.push_back({"How sure", {probability_chart(found)}});
  if (found.normal_plot) page.sections.push_back(normal_section(found));
  if (!found.terms.empty()) page.sections.push_back(terms_section(found));
  if (!found.outliers.empty()) page.sections.push_back(bad_section(found));
  if (!found.bounds.empty() || !found.not_testable.empty())
    page.sections.push_back(bounds_section(found));
  page.sections.push_back(report::glossary());
  page.provenance =
      fmt::format("Made from {} by chaintrue {}; seed {}.", source, CHAINTRUE_VERSION, found.seed);
  return page;
}

}  // namespace chaintrue::cli
