// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue report: a map, a diagnosis or anchors as one HTML page that needs no network.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// A map's certificate: one page to print. What error to expect, with its interval; what was
// measured; what is named; what remains.

/// 95 % of cuts are within this many times the root of the summed variances, if x and y have equal
/// errors: sqrt(-2 ln 0.05) / sqrt(2).
constexpr double k95PerCent = 1.7308;

Section measured_section(const CompensationMap& map) {
  const MapContents& contents = map.contents();
  Table table{.columns = {{"what"}, {"how much, how well"}}};
  const auto row = [&table](std::string what, std::string value) {
    table.add({std::move(what), std::move(value)});
  };
  const std::size_t bad = count_where(contents.points, &MapPoint::bad);
  if (contents.distances) {
    const grid::DistancesUsed& used = *contents.distances;
    row("holes and a tape",
        fmt::format("{} holes, {} distances, {} of them left out", contents.points.size(),
                    used.used + used.rejected, used.rejected));
    row("distances left out are predicted",
        fmt::format("within {:.2f} mm rms, {:.2f} mm at most", used.left_out_good.rms_mm,
                    used.left_out_good.maximum_mm));
    row("error of the readings",
        fmt::format("{:g} mm of tape, {:g} mm of hole; found {:.1f} times as much",
                    used.tape_sigma_mm, contents.noise.position_mm, contents.noise.factor_found));
  } else {
    row("points", fmt::format("{}, {} of them left out", contents.points.size(), bad));
    row("points left out are predicted",
        fmt::format("within {:.2f} mm rms, {:.2f} mm at most",
                    contents.accuracy.leave_one_out.tool.rms_mm,
                    contents.accuracy.leave_one_out.tool.maximum_mm));
    row("error of the readings",
        fmt::format("{:.2f} mm in a length, {:.2f} mm in a position ({})", contents.noise.length_mm,
                    contents.noise.position_mm,
                    contents.noise.source == grid::NoiseSource::stated
                        ? std::string("as given")
                        : fmt::format("from {}", name(contents.noise.source))));
  }
  return {"What was measured", {std::move(table)}};
}

Section named_section(const CompensationMap& map) {
  std::vector<SettingRow> rows = settings_rows(map);
  std::erase_if(rows, [](const SettingRow& row) { return !row.stated_sigma; });
  report::Block block = settings_table(rows);
  if (rows.empty())
    block = Paragraph{"None: the map interpolates the readings, without a machine."};
  return {"The machine's settings", {std::move(block)}};
}

Section remaining_section(const MapContents& contents) {
  constexpr std::size_t kMostNotes = 3;
  Section section{"What remains"};
  for (std::size_t i = 0; i < contents.notes.size() && i < kMostNotes; ++i) {
    section.say(contents.notes[i]);
  }
  if (contents.notes.size() > kMostNotes) {
    section.say("{} more remarks are in the full report.", contents.notes.size() - kMostNotes);
  }
  section.say(
      "After taking the chains off, or after a month of work, measure three to five "
      "points and run chaintrue check.");
  return section;
}

/// `source` is the map's file, for the footer.
Document certificate(const CompensationMap& map, std::string_view source) {
  const MapContents& contents = map.contents();
  const ErrorSummary& expected = contents.accuracy.expected_tool;
  Document page;
  page.title = "Certificate: " + (contents.name.empty() ? std::string("map") : contents.name);
  page.subtitle = map.machine() != nullptr ? map.machine()->name : "no machine model";
  page.verdict = {
      fmt::format("The tool is within {:.2f} mm of where it should be, 95 times in 100, over the "
                  "measured part of the bed.",
                  k95PerCent * expected.rms_mm)};
  page.tone = tone_of(contents);
  page.is_one_sheet = true;
  page.figures = {
      {fmt::format("{:.2f} mm", expected.rms_mm), "expected over the measured part, rms"},
      {fmt::format("0 to {:.2f} mm", k95PerCent * expected.rms_mm), "95 % interval"},
      {fmt::format("{:.2f} mm", expected.maximum_mm),
       fmt::format("at worst, 95 times in 100; largest near ({:.0f}, {:.0f})",
                   contents.accuracy.expected_worst_at.x_mm,
                   contents.accuracy.expected_worst_at.y_mm)}};
  page.not_proved = {
      "These figures hold for the machine as measured, until a motor, a chain or the sheet is "
      "moved."};
  Chart chart = error_map_chart(map_pictures(map));
  chart.caption.clear();  // it is in the legend
  page.sections = {{"Where to expect which error", {std::move(chart)}},
                   measured_section(map),
                   named_section(map),
                   remaining_section(contents)};
  page.provenance = provenance_of(source);
  return page;
}

struct ReportCommand {
  std::string input;
  std::string output;
  bool certificate = false;
  std::string date;
};

/// A page of the file, and the next command.
struct Reported {
  Document page;
  Words next;
};

Reported reported_map(const InputFile& file, bool as_certificate, std::string_view source) {
  const CompensationMap map = load_map(file);
  return {as_certificate ? certificate(map, source) : map_document(map, source),
          map.machine() == nullptr ? Words{"query", file.path, "--help"}
                                   : Words{"plan", "--check", file.path, "-o", "check.csv"}};
}

Reported reported_diagnosis(const InputFile& file, std::string_view source) {
  const Diagnosis found = load_diagnosis(file);
  Words next = {"fit", "--help"};
  if (!found.drawing && found.causes.empty())
    next = {"export", found.belts ? "maslow4" : "groundcontrol", file.path};
  else if (!found.drawing)
    next = {"effects", std::string(found.causes.front().cause.effect->id)};
  return {diagnosis_document(found, source), std::move(next)};
}

Reported reported_anchors(const InputFile& file, std::string_view source) {
  const FittedAnchors found = load_anchors(file);
  return {anchors_document({found.fit, holes_of(found)}, found.name, source),
          {"export", "maslow4", file.path}};
}

/// The name of a page's source: the file, or standard input.
std::string source_of(const InputFile& file) {
  if (file.path != "-") return std::filesystem::path(file.path).filename().string();
  if (file.kind == FileKind::map) return "a map";
  return file.kind == FileKind::anchors ? "anchors" : "a diagnosis";
}

int run_report(Verb verb, const ReportCommand& command) {
  const InputFile file = open_input(command.input);
  require_kind(file, {FileKind::map, FileKind::diagnosis, FileKind::anchors});
  verb.refuse_idle_options(file.fact());
  const std::string source = source_of(file);
  Reported made = file.kind == FileKind::map ? reported_map(file, command.certificate, source)
                  : file.kind == FileKind::diagnosis ? reported_diagnosis(file, source)
                                                     : reported_anchors(file, source);
  if (!command.certificate)
    add_made_by(files::made_by_of(file.text, file.name), made.page.sections);
  // No date is printed, so the same map gives the same page. A certificate has a line to write the
  // date on.
  const std::string date =
      command.date.empty() && command.certificate ? "date: ______________" : command.date;
  if (!date.empty()) {
    std::string& subtitle = made.page.subtitle;
    subtitle += fmt::format("{}{}", subtitle.empty() ? "" : ", ", date);
  }
  write_output(command.output, render_html(made.page));
  if (command.output == "-") return kDone;
  say("The report is {}: open it in any browser.", command.output);
  say_next(made.next);
  return kDone;
}

}  // namespace

void add_report(Verb app) {
  auto [verb, c] = app.add_verb<ReportCommand>(
      "report",
      "Write a map, a diagnosis or the anchors of four belts as a web page that needs no network",
      R"(Examples:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue report map.json -o report.html
  build/chaintrue diagnose fixtures/grids/seven_by_four.json -o diagnosis.json
  build/chaintrue report diagnosis.json -o diagnosis.html)",
      run_report);
  verb.has({{"file", required(reads(c.input)),
             "A chaintrue_map, chaintrue_diagnosis or chaintrue_anchors file; - is standard input"},
            {"-o,--output", required(writes(c.output, {Origin::page})),
             "The HTML file; - is standard output"},
            {"--certificate", c.certificate, "One page of a map, to print", facts::map,
             "to be left out, because only a map has a certificate"},
            {"--date", c.date, "A date to print below the title, as in 2026-11-22"}});
}

}  // namespace chaintrue::cli
