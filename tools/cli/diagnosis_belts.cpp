// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "grid/raster.hpp"
#include "tools/cli/diagnosis_sections.hpp"

namespace chaintrue::cli {

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
    table.add({coordinate_title(c.name), c.before_mm, c.fitted_mm, c.sigma_mm});
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
    table.add({what, before, after});
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

Section drawn_settings_section(const Diagnosis& found) {
  Table table{.columns = {text_column("setting", 24),
                          number_column("as set", 10),
                          number_column("found", 10),
                          number_column("+-", 8),
                          {.gap = 2}}};
  for (const diagnosis::DrawnSetting& own : found.drawing->settings) {
    const auto words = diagnosis::parameter_words(own.name);
    table.add({fmt::format("{}, {}", words.name, words.unit), own.set, own.found, own.sigma},
              own.off, "off");
  }
  return {.title = "Settings of the plotter", .blocks = {std::move(table)}};
}

Section drawn_measures_section(const Diagnosis& found) {
  Table table{.columns = {text_column("measure, mm", 24),
                          number_column("measured", 10),
                          number_column("explained", 11),
                          {.gap = 2}}};
  for (const diagnosis::DrawnValue& own : found.drawing->measures) {
    table.add({own.name, own.measured_mm, own.explained_mm}, own.rejected, "left out");
  }
  return {.title = "What was measured", .blocks = {std::move(table)}};
}

Light drawn_settings_light(const Diagnosis& found) {
  const std::size_t off = count_where(found.drawing->settings, &diagnosis::DrawnSetting::off);
  if (off == 0) return {Tone::good, "Settings right?", "yes"};
  return {Tone::caution, "Settings right?", fmt::format("{} off: type them in", off)};
}

namespace {

/// From Okabe and Ito's palette, distinguishable with every colour vision.
constexpr PerBelt<const char*> kColors = {report::kBeforeColor, report::kAfterColor,
                                          report::kFourthColor, report::kThirdColor};

/// The longest stroke of a good reading, as a share of the frame's width.
constexpr double kLongestStroke = 0.06;
/// The largest ellipse.
constexpr double kLargestEllipse = 0.05;

double width_mm(const BeltsFindings& found) {
  const auto& a = found.machine.anchors;
  return std::max(a.tr.x_mm, a.br.x_mm) - std::min(a.tl.x_mm, a.bl.x_mm);
}

/// One magnification for the residuals with the anchors alone and with the causes.
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
  DataTable table{
      "anchors",
      {"words", "x_mm", "y_mm", "sigma_x_mm", "sigma_y_mm", "color", "is_left", "is_upper"}};
  for (const Belt belt : kBelts) {
    const model::Anchor& anchor = found.machine.anchors[belt];
    table.rows.push_back({std::string(words(belt)), anchor.x_mm, anchor.y_mm,
                          sigma_mm(found, belt, 'x'), sigma_mm(found, belt, 'y'),
                          std::string(kColors[belt]), belt == Belt::tl || belt == Belt::bl,
                          is_upper(belt)});
  }
  return table;
}

DataTable strokes_table(const BeltsFindings& found, PerBelt<double> BeltPlacePicture::*which) {
  DataTable table{"strokes",
                  {"name", "x_mm", "y_mm", "way_x", "way_y", "off_mm", "words", "color", "is_bad"}};
  for (const auto k : each_index(found.places)) {
    const BeltPlacePicture& place = found.places[k];
    for (const Belt belt : kBelts) {
      const model::Anchor& anchor = found.machine.anchors[belt];
      const double x = anchor.x_mm - place.at.x_mm;
      const double y = anchor.y_mm - place.at.y_mm;
      const double away = std::max(std::hypot(x, y), 1e-9);
      const double off = (place.*which)[belt];
      // A bad reading's stroke would leave the picture.
      const double longest = 4.0 * kLongestStroke * width_mm(found) / magnification(found);
      table.rows.push_back({fmt::format("point {}", k + 1), place.at.x_mm, place.at.y_mm, x / away,
                            y / away, place.bad[belt] ? std::clamp(off, -longest, longest) : off,
                            std::string(words(belt)), std::string(kColors[belt]), place.bad[belt]});
    }
  }
  return table;
}

}  // namespace

Chart frame_chart(const BeltsFindings& found, std::string title,
                  PerBelt<double> BeltPlacePicture::*which) {
  Chart chart{.specification = "belt_frame", .title = std::move(title)};
  DataTable frame{"frame", {"x_mm", "y_mm"}};
  const auto& a = found.machine.anchors;
  Rectangle area{};
  for (const model::Anchor& corner : {a.bl, a.tl, a.tr, a.br, a.bl}) {
    frame.rows.push_back({corner.x_mm, corner.y_mm});
    grid::take_in(area, {corner.x_mm, corner.y_mm});
  }
  const double margin = 0.05 * area.width();
  const double drawn = magnification(found);
  const double ellipses = ellipse_magnification(found);
  const double key_mm = report::round_down_125(kLongestStroke * width_mm(found) / drawn);
  chart.data = {std::move(frame), anchors_table(found), strokes_table(found, which)};
  chart.signals = {
      {"x_min_mm", area.x_min - margin},
      {"x_max_mm", area.x_max + margin},
      {"y_min_mm", area.y_min - margin},
      {"y_max_mm", area.y_max + margin},
      {"magnification", drawn},
      {"key_mm", key_mm},
      {"key_text", fmt::format("{:g} mm, drawn {:g} times as long", key_mm, drawn)},
      {"ellipses", ellipses},
      {"ellipses_text", fmt::format("anchors: one sigma, {:g} times as large", ellipses)}};
  return chart;
}

}  // namespace chaintrue::cli
