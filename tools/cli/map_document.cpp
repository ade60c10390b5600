// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <Eigen/LU>
#include <string>
#include <utility>
#include <vector>

#include "grid/map/controller_error.hpp"
#include "grid/map/map_accuracy.hpp"
#include "grid/raster.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {

namespace {

/// Next steps, the most urgent first.
void put_advice(const MapContents& contents, const Machine* machine, std::string_view source,
                Document& document) {
  const auto say = [&document](std::string text) {
    document.advice.push_back({std::move(text), Detail::page});
  };
  for (const auto i : each_index(contents.points)) {
    const MapPoint& point = contents.points[i];
    if (!point.bad) continue;
    say(
        fmt::format("Measure point {} at ({:.0f}, {:.0f}) again: it is {:.1f} mm off the "
                    "prediction by its neighbours.",
                    i + 1, point.mark.x_mm, point.mark.y_mm, point.left_out_mm.norm()));
  }
  for (const grid::SettingResult& result : contents.settings) {
    if (!result.off) continue;
    const SettingWords& words = setting_words(result.setting);
    say(fmt::format("Check \"{}\" with a tape: your file has {:.1f} {}, the points suggest {:.1f}.",
                    words.words, words.factor * result.stated, words.unit,
                    words.factor * result.calibrated));
  }
  if (machine != nullptr) {
    say(fmt::format(
        "Now rewrite each program with it: chaintrue gcode compensate part.nc --map {0} -o "
        "part.true.nc.{1}",
        source,
        machine->controller.settings.motor_spacing_mm
            ? fmt::format(" Or type in better numbers once: chaintrue export groundcontrol {}.",
                          source)
            : ""));
  }
}

void put_figures(const CompensationMap& map, Document& document) {
  const grid::MapAccuracy& accuracy = map.contents().accuracy;
  const auto add = [&document](double value_mm, std::string label) {
    document.figures.push_back({fmt::format("{} mm", about_mm(value_mm)), std::move(label)});
  };
  if (const auto before = error_in_use(map)) {
    add(before->rms_mm, kToolTodayLabel);
    add(before->maximum_mm, "today, at worst");
  }
  add(accuracy.expected_tool.rms_mm, "error of the tool with this map, rms");
  add(accuracy.expected_tool.maximum_mm, "with this map, at worst");
}

Section remarks_section(const CompensationMap& map, std::optional<double> wish_mm) {
  const MapContents& contents = map.contents();
  const grid::MapAccuracy& accuracy = contents.accuracy;
  Section section{"What else was found"};
  if (wish_mm) section.say(wish_sentence(map, *wish_mm));
  if (not_to_cut_with(map).empty()) {
    section.say(worst_sentence(accuracy.expected_worst_at.x_mm, accuracy.expected_worst_at.y_mm,
                               accuracy.expected_tool.maximum_mm));
  }
  if (map.machine() != nullptr && !contents.distances &&
      contents.noise.source != grid::NoiseSource::stated) {
    section.say("Your readings scatter by about {:.2f} mm{}.", noise_at_tool_mm(map),
                contents.noise.source == grid::NoiseSource::repeats
                    ? ", judged by the marks measured twice"
                    : "");
  }
  for (const std::string& note : contents.notes) section.say(note);
  return section;
}

Table left_out_distances(const grid::DistancesUsed& used) {
  return {.columns = {text_column("Error of distances left out one at a time, mm", 48),
                      number_column("rms", 8), number_column("max", 8)},
          .rows = {{{"all", used.left_out_all.rms_mm, used.left_out_all.maximum_mm}},
                   {{"those that fit", used.left_out_good.rms_mm, used.left_out_good.maximum_mm}}},
          .is_headed = true,
          .head_width = 49};
}

Table left_out_points(const CompensationMap& map) {
  const grid::MapAccuracy& accuracy = map.contents().accuracy;
  const bool direct = map.machine() == nullptr;
  Table table{
      .columns = {text_column("Error of points left out, mm", 28), number_column("chain rms", 8),
                  number_column("max", 8), number_column("tool rms", 10), number_column("max", 8)},
      .is_headed = true,
      .head_width = 35};
  const auto row = [&table](const char* what, const grid::HeldOutError& error) {
    table.add({what, error.chain.rms_mm, error.chain.maximum_mm, error.tool.rms_mm,
               error.tool.maximum_mm});
  };
  if (accuracy.leave_one_out.tool.maximum_mm == 0.0) {
    table.add({"not tested: too few rows and columns for it"});
    return table;
  }
  row(direct ? "one column or row at a time" : "one at a time", accuracy.leave_one_out);
  row(direct ? "the worse of the two" : "one block of the bed at a time", accuracy.blocked);
  return table;
}

/// The terminal's details with --verbose.
void add_tables(const CompensationMap& map, std::vector<Section>& sections) {
  const MapContents& contents = map.contents();
  const auto add = [&sections](std::string title, report::Block block) {
    sections.push_back({std::move(title), {std::move(block)}, false, Detail::verbose, false});
  };
  if (!contents.settings.empty()) add("The machine's settings", settings_table(settings_rows(map)));
  add("What was left out",
      contents.distances ? left_out_distances(*contents.distances) : left_out_points(map));
  if (map.machine() != nullptr) add("The points", Paragraph{points_sentence(map)});
  if (contents.mirror) add("One side against the other", Paragraph{contents.mirror->sentence});
}

}  // namespace

Tone tone_of(const MapContents& contents) {
  const bool is_clean = none_of(contents.points, &MapPoint::bad) &&
                        none_of(contents.settings, &grid::SettingResult::off);
  return is_clean ? Tone::good : Tone::caution;
}

std::string provenance_of(std::string_view source) {
  return fmt::format("Made from {} by chaintrue {}.", source, CHAINTRUE_VERSION);
}

Document map_document(const CompensationMap& map, std::string_view source, Detail detail,
                      std::optional<double> wish_mm) {
  const MapContents& contents = map.contents();
  Document document;
  document.title = contents.name.empty() ? "Compensation map"
                                         : fmt::format("Compensation map: {}", contents.name);
  document.subtitle =
      fmt::format("{}, {} points", map.machine() ? map.machine()->name : "no machine model",
                  contents.points.size());
  document.verdict = {fit_sentence(map)};
  document.tone = tone_of(contents);
  put_advice(contents, map.machine(), source, document);
  document.not_proved = {
      "These figures hold for the machine as measured, until a motor, a chain or the sheet is "
      "moved. They do not show the cause of the error.",
      Detail::page};
  put_figures(map, document);
  document.remarks = remarks_section(map, wish_mm);
  if (detail == Detail::page) document.sections = picture_sections(map_pictures(map));
  add_tables(map, document.sections);
  document.has_glossary = true;
  document.provenance = provenance_of(source);
  return document;
}

// The data of a compensation map's pictures.
namespace {

using report::ErrorStep;

/// The error map's raster over the sheet: squares of some 60 mm on a full sheet.
constexpr int kColumns = 41;
constexpr int kRows = 21;

/// An arrow from where the model puts the tool to where it landed.
report::ToolVector tool_vector(const Eigen::Vector2d& residual_mm) {
  return {residual_mm.x(), residual_mm.y()};
}

/// The machine's bed; without a machine, the measured part.
Rectangle mapped_sheet(const CompensationMap& map) {
  const Machine* machine = map.machine();
  return machine == nullptr ? map.contents().domain : grid::area_of(machine->bed);
}

std::vector<report::ReportPoint> points_of(const CompensationMap& map) {
  const MapContents& contents = map.contents();
  const Residual before = residual_before(contents);
  std::vector<report::ReportPoint> points;
  for (const auto i : each_index(contents.points)) {
    const MapPoint& from = contents.points[i];
    report::ReportPoint point{
        .name = fmt::format("point {}", i + 1), .x_mm = from.mark.x_mm, .y_mm = from.mark.y_mm};
    if (map.machine() != nullptr) {
      point.before = tool_vector(from.*before);
      point.after = tool_vector(from.mapped_mm);
    }
    // The places of holes are known only through the distances used by the fit.
    if (!contents.distances) {
      point.held_out = tool_vector(from.left_out_mm);
      point.held_out_sigmas = from.distance_sigmas;
    }
    point.is_bad = from.bad;
    points.push_back(std::move(point));
  }
  return points;
}

report::ErrorMap error_map_of(const CompensationMap& map, const Rectangle& sheet) {
  report::ErrorMap raster{sheet.width() / kColumns, sheet.height() / kRows, {}};
  for (const MarkPoint& at : grid::raster(sheet, kColumns, kRows, grid::RasterOf::cells)) {
    if (const auto answer = map.query(at)) {
      raster.cells.push_back(
          {at.x_mm, at.y_mm, answer->tool_sigma_mm, std::string(name(answer->status))});
    }
  }
  return raster;
}

std::vector<ErrorStep> steps_of(const CompensationMap& map, double noise_mm) {
  const MapContents& contents = map.contents();
  std::vector<ErrorStep> steps;
  const auto add = [&steps](ErrorStep::Kind kind, std::string what, const ErrorSummary& error,
                            std::string note) {
    steps.push_back({kind, std::move(what), error.rms_mm, error.maximum_mm, std::move(note)});
  };
  if (map.machine() != nullptr) {
    add(ErrorStep::Kind::before, "machine file as it was",
        summary_of(contents, &MapPoint::as_stated_mm), "at the measured points");
    if (has_placed_sheet(contents)) {
      add(ErrorStep::Kind::before, "sheet found", summary_of(contents, &MapPoint::sheet_placed_mm),
          "the same, for the best placement of the sheet");
    }
    add(ErrorStep::Kind::after, "map, its own points", summary_of(contents, &MapPoint::mapped_mm),
        "residual of the fit; not a measure of accuracy");
  }
  if (contents.distances) {
    add(ErrorStep::Kind::after, "distances left out", contents.distances->left_out_good,
        "each distance predicted by a fit without it, along the tape; includes the tape's noise");
  } else {
    add(ErrorStep::Kind::after, "map, points left out", contents.accuracy.leave_one_out.tool,
        "each point predicted by a map without it; includes that reading's noise");
    add(ErrorStep::Kind::after, "map, regions left out", contents.accuracy.blocked.tool,
        "a block of the bed predicted by a map without it");
  }
  if (noise_mm > 0.0) {
    steps.push_back({ErrorStep::Kind::reference,
                     "noise of a reading",
                     noise_mm,
                     {},
                     fmt::format("{:.2g} mm per chain and {:.2g} mm per mark, {}",
                                 contents.noise.length_mm, contents.noise.position_mm,
                                 contents.noise.source == grid::NoiseSource::stated
                                     ? std::string("as given")
                                     : fmt::format("found from {}", name(contents.noise.source)))});
  }
  add(ErrorStep::Kind::reference, "map, expected", contents.accuracy.expected_tool,
      "one sigma relative to the true machine, over the measured part");
  return steps;
}

}  // namespace

report::MapPictures map_pictures(const CompensationMap& map) {
  const double noise_mm = noise_at_tool_mm(map);
  report::MapPictures pictures;
  const Rectangle sheet = mapped_sheet(map);
  pictures.sheet = {sheet.x_min, sheet.x_max, sheet.y_min, sheet.y_max};
  pictures.before_what = machine_before(map.contents());
  pictures.steps = steps_of(map, noise_mm);
  pictures.points = points_of(map);
  pictures.error_map = error_map_of(map, sheet);
  pictures.held_out_rms_mm = map.contents().accuracy.leave_one_out.tool.rms_mm;
  pictures.noise_floor_mm = noise_mm;
  return pictures;
}

}  // namespace chaintrue::cli
