// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_sections.hpp"

namespace chaintrue::cli {

using diagnosis::BeltPlacePicture;
using diagnosis::BeltsFindings;
using report::number_column;
using report::text_column;

Section frame_section(const Diagnosis& found) {
  const BeltsFindings& belts = *found.belts;
  Chart before = frame_chart(belts, "Anchors alone", &BeltPlacePicture::before_mm);
  before.caption = kFrameCaption;
  Section section{"The frame, and the residuals of its belts", {std::move(before)}};
  if (found.causes.empty()) return section;
  Chart after = frame_chart(belts, found.causes.size() > 1 ? "With the causes" : "With the cause",
                            &BeltPlacePicture::after_mm);
  after.caption = "The same scale. Strokes in random directions are noise.";
  section.blocks.emplace_back(std::move(after));
  return section;
}

Section anchors_section(const Diagnosis& found) {
  Table table{.columns = {text_column("Anchor", 6), number_column("alone", 12),
                          number_column("with the causes", 17), number_column("+-", 8),
                          number_column("in force", 10, 1)},
              .caption = kAnchorsCaption,
              .is_headed = true};
  for (const auto& c : found.belts->coordinates) {
    table.rows.push_back({{coordinate_title(c.name), c.before_mm, c.fitted_mm, c.sigma_mm}});
    if (c.stated_mm) table.rows.back().cells.emplace_back(*c.stated_mm);
  }
  return {"The anchors, mm", {std::move(table)}};
}

Section belts_improvement_section(const Diagnosis& found) {
  const BeltsFindings& belts = *found.belts;
  Table table{.columns = {text_column("mm", 39), number_column("anchors alone", 13),
                          number_column("with the causes", 18)},
              .is_headed = true};
  const auto row = [&table](const char* what, double before, double after) {
    table.rows.push_back({{what, before, after}});
  };
  row("error of one belt's reading", belts.spread_before_mm, belts.residual_sigma_mm);
  row("rms over all readings", belts.rms_before_mm, belts.rms_mm);
  if (belts.prediction && belts.prediction_before) {
    row("lower belts predicted at places left out", belts.prediction_before->rms_mm,
        belts.prediction->rms_mm);
  }
  row("the tool, over the measured places", belts.tool.before_mm, belts.tool.after_mm);
  std::string text =
      "The tool's error is relative to the model with the named causes, with free position and "
      "rotation of the frame. Both columns include the uncertainty of the readings";
  text += belts.tool.scale_mm_per_m
              ? fmt::format("; with the tape the scale is uncertain by {:.2f} mm per metre.",
                            *belts.tool.scale_mm_per_m)
              : ". It is in millimetres of belt, whose true length belts do not show.";
  return {"Improvement with the named cause", {std::move(table), Paragraph{std::move(text)}}};
}

Light scale_light(const Diagnosis& found) {
  const bool known = found.belts->scale.has_value();
  return {known ? Tone::good : Tone::caution, "Scale known?",
          known ? "yes, from the tape" : "no, not taped"};
}

std::vector<Figure> figures_of_belts(const Diagnosis& found) {
  const BeltsFindings& belts = *found.belts;
  return {{fmt::format("{:.2f} mm", belts.spread_before_mm), "error of one belt, anchors alone"},
          {fmt::format("{:.2f} mm", belts.residual_sigma_mm), "with what is named"}};
}

using diagnosis::DrawnSetting;
using diagnosis::DrawnValue;

Section drawn_settings_section(const Diagnosis& found) {
  Table table{.columns = {text_column("setting", 24),
                          number_column("as set", 10),
                          number_column("found", 10),
                          number_column("+-", 8),
                          {.gap = 2}}};
  for (const DrawnSetting& own : found.drawing->settings) {
    const auto words = diagnosis::parameter_words(own.name);
    table.rows.push_back(report::row_with_flag(
        {fmt::format("{}, {}", words.name, words.unit), own.set, own.found, own.sigma}, own.off,
        "off"));
  }
  return {.title = "Settings of the plotter", .blocks = {std::move(table)}};
}

Section drawn_measures_section(const Diagnosis& found) {
  Table table{.columns = {text_column("measure, mm", 24),
                          number_column("measured", 10),
                          number_column("explained", 11),
                          {.gap = 2}}};
  for (const DrawnValue& own : found.drawing->measures) {
    table.rows.push_back(report::row_with_flag({own.name, own.measured_mm, own.explained_mm},
                                               own.rejected, "left out"));
  }
  return {.title = "What was measured", .blocks = {std::move(table)}};
}

Light drawn_settings_light(const Diagnosis& found) {
  const auto& settings = found.drawing->settings;
  const auto off = std::count_if(settings.begin(), settings.end(),
                                 [](const DrawnSetting& own) { return own.off; });
  if (off == 0) return {Tone::good, "Settings right?", "yes"};
  return {Tone::caution, "Settings right?", fmt::format("{} off: type them in", off)};
}

}  // namespace chaintrue::cli
