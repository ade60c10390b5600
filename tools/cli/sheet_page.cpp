// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/sheet.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/plane_vectors.hpp"
#include "tools/cli/svg.hpp"
#include "tools/report/embedded.hpp"

namespace chaintrue::cli {
namespace {

/// A drawing of how to take a reading, not to scale.
std::string_view how_to(std::string_view take) {
  return report::embedded_text("asset", fmt::format("how_{}.svg", take));
}

using report::escaped;

constexpr std::string_view kSheetStyle = R"(
@page { margin: 12mm; }
body { font: 10pt/1.35 sans-serif; color: #111; background: #fff; max-width: 186mm;
  margin: 0 auto; padding: 2mm; }
h1 { font-size: 14pt; margin: 0 0 2mm; }
.drawings { display: flex; gap: 4mm; align-items: center; break-inside: avoid; }
.drawings > div:first-child { flex: 5; }
.drawings > div { flex: 3; }
svg { display: block; width: 100%; height: auto; }
ol { margin: 2mm 0; padding-left: 6mm; }
.tables { display: flex; gap: 4mm; align-items: flex-start; margin-top: 2mm; }
table { border-collapse: collapse; width: 100%; }
th, td { border: 0.3mm solid #555; padding: 0.5mm 1.5mm; text-align: right; line-height: 1.25; }
td { height: 5.6mm; font-size: 9.5pt; }
th { background: #eee; font-size: 8.5pt; }
td.blank { width: 23%; }
td:first-child, th:first-child { text-align: left; white-space: nowrap; }
tr { break-inside: avoid; }
@media screen and (max-width: 600px) { .drawings, .tables { flex-direction: column; align-items: stretch; } }
)";

/// Two tables next to each other, so that an evening's readings are on one sheet of paper; the next
/// two below, on the next sheet.
std::string tables_of(const std::string& head, const Words& rows) {
  // Space on A4 and Letter below the drawings, and on a whole sheet.
  constexpr std::size_t kFirstSheet = 2 * 18, kNextSheets = 2 * 36;
  std::string text;
  std::size_t from = 0;
  while (from < rows.size()) {
    const std::size_t count = std::min(rows.size() - from, from == 0 ? kFirstSheet : kNextSheets);
    const std::size_t middle = from + (count + 1) / 2;
    text += "<div class=\"tables\">\n";
    for (const auto& [begin, end] : {std::pair(from, middle), std::pair(middle, from + count)}) {
      if (begin == end) continue;
      text += fmt::format("<table><thead><tr>{}</tr></thead><tbody>\n", head);
      for (std::size_t i = begin; i < end; ++i) text += rows[i];
      text += "</tbody></table>\n";
    }
    text += "</div>\n";
    from += count;
  }
  return text;
}

std::string page_of(const std::string& title, const std::string& bed, std::string_view how,
                    const Words& steps, const std::string& head, const Words& rows) {
  std::string list = "<ol>\n";
  for (const std::string& step : steps) list += fmt::format("<li>{}</li>\n", escaped(step));
  list += "</ol>";
  // With this many lines the bed fits over the sheet's whole width.
  constexpr std::size_t kFewLines = 24;
  const std::string top =
      rows.size() <= kFewLines
          ? fmt::format("{}\n<div class=\"drawings\"><div>{}</div><div>{}</div></div>", bed, list,
                        how)
          : fmt::format("<div class=\"drawings\"><div>{}</div><div>{}</div></div>\n{}", bed, how,
                        list);
  return fmt::format(
      R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{0}</title>
<style>{1}</style></head><body>
<h1>{0}</h1>
{2}
{3}</body></html>
)",
      escaped(title), kSheetStyle, top, tables_of(head, rows));
}

/// The bed as it hangs, numbered marks along the way from one to the next.
std::string drawing_of(const Sheet& sheet, const Bed& bed) {
  constexpr double kDrawingWide = 900.0;
  constexpr double kEdge = 20.0;
  const BedView view{grid::area_of(bed), {kEdge, kEdge}, kDrawingWide};
  const auto x = [&](MarkPoint at) { return view.x(at.x_mm); };
  const auto y = [&](MarkPoint at) { return view.y(at.y_mm); };
  Svg svg(kDrawingWide + 2.0 * kEdge, view.high() + 2.0 * kEdge, "role=\"img\"",
          "The bed with its numbered marks");
  svg.rectangle(kEdge, kEdge, kDrawingWide, view.high(),
                "fill=\"none\" stroke=\"#111\" stroke-width=\"2\"");
  const std::vector<SheetVisit> visits = visits_of(sheet);
  std::string walk;
  for (const SheetVisit& visit : visits)
    walk += fmt::format("{:.1f},{:.1f} ", x(visit.mark), y(visit.mark));
  svg.add("<polyline fill=\"none\" stroke=\"#999\" stroke-dasharray=\"6 5\" points=\"{}\"/>\n",
          walk);
  // As large as the distance of the nearest two marks allows.
  double nearest = 80.0;
  for (const auto i : each_index(sheet.marks)) {
    for (std::size_t k = 0; k < i; ++k) {
      nearest = std::min(nearest, view.scale() * grid::distance_mm(sheet.marks[i], sheet.marks[k]));
    }
  }
  const double radius = std::clamp(0.45 * nearest, 3.0, 16.0);
  for (const SheetVisit& visit : visits) {
    if (visit.again != 0) continue;
    svg.circle(x(visit.mark), y(visit.mark), radius,
               "fill=\"#fff\" stroke=\"#111\" stroke-width=\"1.5\"");
    svg.text(x(visit.mark), y(visit.mark) + 0.35 * radius, fmt::format("{}", visit.number),
             "middle", fmt::format(" font-size=\"{:.1f}\"", radius));
  }
  return svg.finished();
}

std::string blank_cells(int count) {
  std::string cells;
  for (int i = 0; i < count; ++i) cells += "<td class=\"blank\"></td>";
  return cells;
}

std::string typed_into(const std::string& list) {
  return fmt::format("Type the readings into {}; leave cells empty if you did not measure them.",
                     list.empty() || list == "-" ? "the list" : list);
}

}  // namespace

std::string sheet_page(const Sheet& sheet, const Machine& machine, const std::string& list) {
  const bool places = sheet.of == SheetOf::places;
  const std::string head =
      fmt::format("<th>mark</th><th>{0}x, mm</th><th>{0}y, mm</th><th>{1}</th><th>{2}</th>",
                  places ? "sent to " : "", places ? "measured x, mm" : "left chain, mm",
                  places ? "measured y, mm" : "right chain, mm");
  const std::vector<SheetVisit> visits = visits_of(sheet);
  Words rows;
  for (const SheetVisit& visit : visits) {
    rows.push_back(fmt::format("<tr><td>{}</td><td>{:.0f}</td><td>{:.0f}</td>{}</tr>\n",
                               visit.name(), visit.mark.x_mm + 0.0, visit.mark.y_mm + 0.0,
                               blank_cells(2)));
  }
  Words steps =
      places ? Words{
                   "Fasten a sheet to the bed and do not move it until everything is measured. Zero is the middle of the bed, x to the right, y up.",
                   "Send the tool to the marks in numerical order, without any compensation, and mark where it stops (or run the program that drills them).",
                   "Measure x and y of every mark from the sheet's middle lines, to half a millimetre or better."}
             : Words{
                   "Draw the marks on a sheet. Zero is the middle of the bed, x to the right, y up.",
                   "Bring the bit over each mark in numerical order. If it is not exactly on the mark, measure its position. Write down the lengths of both chains from the pin at 12 o'clock to their ends at the ring."};
  const std::size_t second = visits.size() - sheet.marks.size();
  if (second > 0) {
    steps.push_back(fmt::format(
        "{} marks are repeated later in the session{}. Measure them like any other; the two "
        "readings show whether the machine changed in between.",
        second,
        places ? fmt::format(" and {:g} mm to the side, so that they are separate holes", kBesideMm)
               : ""));
  }
  steps.push_back(typed_into(list));
  return page_of(second == 0 ? fmt::format("{} marks for {}", sheet.marks.size(), machine.name)
                             : fmt::format("{} marks, {} of them twice, for {}", sheet.marks.size(),
                                           second, machine.name),
                 drawing_of(sheet, machine.bed), how_to(places ? "middle_lines" : "chain_length"),
                 steps, head, rows);
}

std::string holes_page(const HolesPlan& plan, const std::string& list) {
  Words rows;
  for (const grid::HoleDistance& distance : plan.set.distances) {
    rows.push_back(fmt::format("<tr><td>{}</td><td>{}</td><td>{:.0f}</td>{}</tr>\n",
                               escaped(plan.set.holes[distance.from].name),
                               distance.edge ? fmt::format("{} edge", name(*distance.edge))
                                             : escaped(plan.set.holes[distance.to].name),
                               distance.distance_mm, blank_cells(1)));
  }
  return page_of(
      fmt::format("{} holes for {}", plan.set.holes.size(), plan.set.machine->name),
      draw_holes_plan(plan), how_to("tape_and_hook"),
      {"Fasten a sheet to the bed. Cut the holes with the program, or send the tool to "
       "each; zero is the middle of the bed.",
       "Measure from centre to centre. The hook at the tape's end has play, so hold the 100 mm "
       "mark at the first hole, write down the tape's reading, and fit with --hook-offset-mm 100.",
       "Check every number twice: one misread distance does more harm than a missing hole.",
       typed_into(list)},
      "<th>from</th><th>to</th><th>about, mm</th><th>tape reading, mm</th>", rows);
}

}  // namespace chaintrue::cli
