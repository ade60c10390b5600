// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/belts_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// Of Okabe and Ito's palette, told apart with every colour vision.
constexpr model::PerBelt<const char*> kColors = {"#d55e00", "#0072b2", "#cc79a7", "#009e73"};

/// The longest stroke of a good reading, as a share of the frame's width.
constexpr double kLongestStroke = 0.06;
/// The largest ellipse.
constexpr double kLargestEllipse = 0.05;

double width_mm(const BeltsFindings& found) {
  const auto& a = found.machine.anchors;
  return std::max(a.tr.x_mm, a.br.x_mm) - std::min(a.tl.x_mm, a.bl.x_mm);
}

/// One magnification for what the anchors alone leave and for what is left beside the causes.
double magnification(const BeltsFindings& found) {
  double most = 0.0;
  for (const BeltPlacePicture& place : found.places) {
    for (const Belt belt : kBelts) {
      if (!place.bad[belt]) most = std::max(most, std::abs(place.before_mm[belt]));
    }
  }
  return most > 0.0 ? report::round_down_125(kLongestStroke * width_mm(found) / most) : 1.0;
}

double sigma_mm(const BeltsFindings& found, Belt belt, char axis) {
  const std::string wanted = fmt::format("{}_{}_mm", name(belt), axis);
  for (const auto& c : found.coordinates) {
    if (c.name == wanted) return c.sigma_mm;
  }
  return 0.0;
}

double ellipse_magnification(const BeltsFindings& found) {
  double most = 0.0;
  for (const auto& c : found.coordinates) most = std::max(most, c.sigma_mm);
  return most > 0.0
             ? std::max(1.0, report::round_down_125(kLargestEllipse * width_mm(found) / most))
             : 1.0;
}

DataTable anchors_table(const BeltsFindings& found) {
  DataTable table{"anchors",
                  {"words", "x_mm", "y_mm", "sigma_x_mm", "sigma_y_mm", "color", "is_left", "is_upper"},
                  {}};
  for (const Belt belt : kBelts) {
    const model::Anchor& anchor = found.machine.anchors[belt];
    table.rows.push_back({std::string(model::words(belt)),
                          anchor.x_mm,
                          anchor.y_mm,
                          sigma_mm(found, belt, 'x'),
                          sigma_mm(found, belt, 'y'),
                          std::string(kColors[belt]),
                          belt == Belt::tl || belt == Belt::bl,
                          model::is_upper(belt)});
  }
  return table;
}

DataTable strokes_table(const BeltsFindings& found,
                        model::PerBelt<double> BeltPlacePicture::*which) {
  DataTable table{
      "strokes", {"name", "x_mm", "y_mm", "way_x", "way_y", "off_mm", "words", "color", "is_bad"}, {}};
  for (std::size_t k = 0; k < found.places.size(); ++k) {
    const BeltPlacePicture& place = found.places[k];
    for (const Belt belt : kBelts) {
      const model::Anchor& anchor = found.machine.anchors[belt];
      const double x = anchor.x_mm - place.at.x_mm;
      const double y = anchor.y_mm - place.at.y_mm;
      const double away = std::max(std::hypot(x, y), 1e-9);
      const double off = (place.*which)[belt];
      // A bad reading's stroke would leave the picture.
      const double longest = 4.0 * kLongestStroke * width_mm(found) / magnification(found);
      table.rows.push_back({fmt::format("point {}", k),
                            place.at.x_mm,
                            place.at.y_mm,
                            x / away,
                            y / away,
                            place.bad[belt] ? std::clamp(off, -longest, longest) : off,
                            std::string(model::words(belt)),
                            std::string(kColors[belt]),
                            place.bad[belt]});
    }
  }
  return table;
}

Chart frame_chart(const BeltsFindings& found,
                  std::string title,
                  model::PerBelt<double> BeltPlacePicture::*which) {
  Chart chart{.specification = "belt_frame", .title = std::move(title)};
  DataTable frame{"frame", {"x_mm", "y_mm"}, {}};
  const auto& a = found.machine.anchors;
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0;
  for (const model::Anchor& corner : {a.bl, a.tl, a.tr, a.br, a.bl}) {
    frame.rows.push_back({corner.x_mm, corner.y_mm});
    x_min = std::min(x_min, corner.x_mm);
    x_max = std::max(x_max, corner.x_mm);
    y_min = std::min(y_min, corner.y_mm);
    y_max = std::max(y_max, corner.y_mm);
  }
  const double margin = 0.05 * (x_max - x_min);
  const double drawn = magnification(found);
  const double ellipses = ellipse_magnification(found);
  const double key_mm = report::round_down_125(kLongestStroke * width_mm(found) / drawn);
  chart.data = {std::move(frame), anchors_table(found), strokes_table(found, which)};
  chart.signals = {{"x_min_mm", x_min - margin},
                   {"x_max_mm", x_max + margin},
                   {"y_min_mm", y_min - margin},
                   {"y_max_mm", y_max + margin},
                   {"magnification", drawn},
                   {"key_mm", key_mm},
                   {"key_text", fmt::format("{:g} mm, drawn {:g} times as long", key_mm, drawn)},
                   {"ellipses", ellipses},
                   {"ellipses_text", fmt::format("anchors: one sigma, {:g} times as large", ellipses)}};
  return chart;
}

Section frame_section(const Diagnosis& found) {
  const BeltsFindings& belts = *found.belts;
  Chart before = frame_chart(belts, "Anchors alone", &BeltPlacePicture::before_mm);
  before.caption =
      "A stroke lies along its belt, in that anchor's colour: towards the anchor where the belt reads "
      "long, away from it where it reads short. Circled: set aside.";
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
