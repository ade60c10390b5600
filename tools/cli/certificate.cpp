// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tools/cli/map_document.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

/// 95 % of cuts are within this many times the root of the summed variances, if x and y have equal
/// errors: sqrt(-2 ln 0.05) / sqrt(2).
constexpr double k95PerCent = 1.7308;

Section measured_section(const CompensationMap& map) {
  const MapContents& contents = map.contents();
  Table table{.columns = {{"what"}, {"how much, how well"}}, .rows = {}, .caption = {}};
  const auto row = [&table](std::string what, std::string value) {
    table.rows.push_back({{std::move(what), std::move(value)}});
  };
  const auto bad = std::count_if(
      contents.points.begin(), contents.points.end(), [](const auto& p) { return p.bad; });
  if (contents.distances) {
    const grid::DistancesUsed& used = *contents.distances;
    row("holes and a tape",
        fmt::format("{} holes, {} distances, {} of them left out",
                    contents.points.size(),
                    used.used + used.rejected,
                    used.rejected));
    row("distances left out are predicted",
        fmt::format("within {:.2f} mm rms, {:.2f} mm at most",
                    used.left_out_good.rms_mm,
                    used.left_out_good.maximum_mm));
    row("error of the readings",
        fmt::format("{:g} mm of tape, {:g} mm of hole; found {:.1f} times as much",
                    used.tape_sigma_mm,
                    contents.noise.position_mm,
                    contents.noise.factor_found));
  } else {
    row("points", fmt::format("{}, {} of them left out", contents.points.size(), bad));
    row("points left out are predicted",
        fmt::format("within {:.2f} mm rms, {:.2f} mm at most",
                    contents.accuracy.leave_one_out.tool.rms_mm,
                    contents.accuracy.leave_one_out.tool.maximum_mm));
    row("error of the readings",
        fmt::format("{:.2f} mm in a length, {:.2f} mm in a position ({})",
                    contents.noise.length_mm,
                    contents.noise.position_mm,
                    contents.noise.source == grid::NoiseSource::stated
                        ? std::string("as given")
                        : fmt::format("from {}", name(contents.noise.source))));
  }
  Section section{"What was measured", {}};
  section.blocks.push_back(std::move(table));
  return section;
}

Section named_section(const CompensationMap& map) {
  std::vector<SettingRow> rows = settings_rows(map);
  std::erase_if(rows, [](const SettingRow& row) { return !row.stated_sigma; });
  Section section{"The machine's settings", {}};
  if (rows.empty()) {
    section.blocks.push_back(
        Paragraph{"None: the map interpolates the readings, without a machine."});
  } else {
    section.blocks.push_back(settings_table(rows));
  }
  return section;
}

Section remaining_section(const MapContents& contents) {
  constexpr std::size_t kMostNotes = 3;
  Section section{"What remains", {}};
  for (std::size_t i = 0; i < contents.notes.size() && i < kMostNotes; ++i) {
    section.blocks.push_back(Paragraph{contents.notes[i]});
  }
  if (contents.notes.size() > kMostNotes) {
    section.blocks.push_back(Paragraph{fmt::format("{} more remarks are in the full report.",
                                                   contents.notes.size() - kMostNotes)});
  }
  section.blocks.push_back(
      Paragraph{"After taking the chains off, or after a month of work, measure three to five "
                "points and run chaintrue check."});
  return section;
}

}  // namespace

Document certificate(const CompensationMap& map, std::string_view source) {
  const MapContents& contents = map.contents();
  const grid::ErrorSummary& expected = contents.accuracy.expected_tool;
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
  Chart chart = report::error_map_chart(map_pictures(map));
  chart.caption.clear();  // it is in the legend
  Section error_section{"Where to expect which error", {}};
  error_section.blocks.push_back(std::move(chart));
  page.sections.push_back(std::move(error_section));
  page.sections.push_back(measured_section(map));
  page.sections.push_back(named_section(map));
  page.sections.push_back(remaining_section(contents));
  page.provenance = provenance_of(source);
  return page;
}

}  // namespace chaintrue::cli
