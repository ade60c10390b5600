// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/files/drawing_file.hpp"
#include "grid/files/plotter_file.hpp"
#include "grid/plotter/drawing_fit.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {
namespace {

using grid::DrawingFit;
using grid::FittedMeasure;
using grid::TestDrawing;
using report::number_column;

struct PlotterSettingWords {
  std::string_view noun;
  std::string_view unit = "mm";
};

/// An owner's words for a parameter of the mechanism.
PlotterSettingWords plotter_setting_words(std::size_t parameter) {
  constexpr PlotterSettingWords kWords[] = {
      {"distance between the pins"},
      {"height of the right pin over the left"},
      {"zero of the left cord"},
      {"zero of the right cord"},
      {"excess of the left cord", "mm per metre"},
      {"excess of the right cord", "mm per metre"},
  };
  return kWords[parameter];
}

double largest_bow(const TestDrawing& drawing, const DrawingFit& fit,
                   double FittedMeasure::*value) {
  double most = 0.0;
  for (const auto i : each_index(fit.measures)) {
    if (drawing.measures[i].kind == grid::observation::DrawnMeasure::Kind::bow &&
        !fit.measures[i].rejected)
      most = std::max(most, std::abs(fit.measures[i].*value));
  }
  return most;
}

std::string sentence_of_settings(const DrawingFit& fit) {
  std::string named;
  for (const auto k : each_index(fit.settings)) {
    const grid::PlotterSetting& own = fit.settings[k];
    if (!own.is_off) continue;
    named += fmt::format("{}the {}, by {:+.2f} +- {:.2f} {}", named.empty() ? "" : "; ",
                         plotter_setting_words(k).noun, own.found - own.stated, own.sigma,
                         plotter_setting_words(k).unit);
  }
  if (named.empty()) return "No setting is off significantly.";
  return fmt::format("Significantly off: {}.", named);
}

Table table_of_settings(const DrawingFit& fit) {
  Table table{.columns = {report::text_column("setting", 46),
                          number_column("as set", 10),
                          number_column("found", 10),
                          number_column("+-", 8),
                          {.gap = 2}}};
  for (const auto k : each_index(fit.settings)) {
    const grid::PlotterSetting& own = fit.settings[k];
    const PlotterSettingWords words = plotter_setting_words(k);
    table.add({fmt::format("{}, {}", words.noun, words.unit), own.stated, own.found, own.sigma},
              own.is_off, "off");
  }
  return table;
}

Table table_of_measures(const TestDrawing& drawing, const DrawingFit& fit) {
  Table table{.columns = {report::text_column("measure, mm", 22),
                          number_column("measured", 10),
                          number_column("fitted", 10),
                          number_column("next page", 11),
                          {.gap = 2}}};
  for (const auto i : each_index(fit.measures)) {
    const FittedMeasure& own = fit.measures[i];
    table.add({grid::words_of(drawing, i), own.measured_mm, own.found_mm, own.after_mm},
              own.rejected, "left out");
  }
  return table;
}

Document drawing_document(const TestDrawing& drawing, const DrawingFit& fit) {
  Document document;
  document.title = fmt::format("Test drawing: {}", drawing.name);
  document.verdict = {
      fmt::format("The lines bow by up to {:.1f} mm. After typing in the new numbers, the lines of "
                  "the next page will bow by up to {:.1f} mm.",
                  largest_bow(drawing, fit, &FittedMeasure::measured_mm),
                  largest_bow(drawing, fit, &FittedMeasure::after_mm))};
  document.remarks.say(sentence_of_settings(fit));
  for (const auto i : each_index(fit.measures)) {
    if (!fit.measures[i].rejected) continue;
    document.remarks.say(
        fmt::format("{} was left out: {:.1f} mm was read, but the others predict {:.1f} "
                    "mm. Measure it again.",
                    grid::words_of(drawing, i), fit.measures[i].measured_mm,
                    fit.measures[i].found_mm),
        Detail::always, true);
  }
  document.sections = {{"Settings", {table_of_settings(fit)}},
                       {"Measures", {table_of_measures(drawing, fit)}, false, Detail::verbose}};
  return document;
}

}  // namespace

int fit_the_drawing(Verb verb, const FitCommand& command, const InputFile& file) {
  const TestDrawing drawing = files::parse_drawing(file.text, file.name);
  const auto fit = fit_drawing(drawing);
  if (!fit) {
    say("{}: {}", file.name, fit.error().sentence());
    if (fit.error().reason == grid::DrawingReason::no_settings_fit)
      say_next({"diagnose", file.path});
    return kBadInput;
  }
  const std::string text = files::write_plotter({drawing, found_by(*fit)}, {}, made_by(verb));
  write_fitted(command, text, text, drawing_document(drawing, *fit));
  say_next({"export", "plotter", command.output});
  return kDone;
}

}  // namespace chaintrue::cli
