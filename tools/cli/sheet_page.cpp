// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/svg.hpp"

namespace chaintrue::cli {
namespace {

// Drawings of how to take a reading, for printed sheets. Each is one SVG with a title, without a
// script; nothing in it is to scale.

constexpr double kHowWide = 380.0, kHowHigh = 200.0;

/// Objects in black, measurements in blue.
class Drawing : public Svg {
 public:
  explicit Drawing(std::string_view title)
      : Svg(kHowWide, kHowHigh, "class=\"how\" font-size=\"13\" role=\"img\"", title) {}
  void path(std::string_view d, std::string_view look = "fill=\"none\" stroke=\"#111\"") {
    Svg::path(d, look);
  }
  void text(double x, double y, std::string_view words, std::string_view anchor = "middle") {
    Svg::text(x, y, words, anchor);
  }
  /// A measured length, with an arrow head at either end.
  void measure(double x1, double y1, double x2, double y2) {
    const std::string blue =
        fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", report::kAfterColor);
    path(fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}{}{}",
                     x1,
                     y1,
                     x2,
                     y2,
                     head(x1, y1, x2, y2),
                     head(x2, y2, x1, y1)),
         blue);
  }

 private:
  /// At (x, y), of an arrow that comes from (from_x, from_y).
  static std::string head(double x, double y, double from_x, double from_y) {
    constexpr double kLong = 7.0, kHalfOpening = 0.4;
    const double back = std::atan2(from_y - y, from_x - x);
    return fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}",
                       x + kLong * std::cos(back - kHalfOpening),
                       y + kLong * std::sin(back - kHalfOpening),
                       x,
                       y,
                       x + kLong * std::cos(back + kHalfOpening),
                       y + kLong * std::sin(back + kHalfOpening));
  }
};

constexpr std::string_view kWood = "fill=\"#f7f1e6\" stroke=\"#111\"";
constexpr std::string_view kSteel = "fill=\"#e3e7ec\" stroke=\"#111\"";
constexpr std::string_view kHole = "fill=\"#fff\" stroke=\"#111\" stroke-width=\"1.5\"";

/// x and y of a mark from the sheet's middle lines, with a square.
std::string draw_middle_lines() {
  Drawing drawing("A mark measured from the middle lines of the sheet with a square");
  drawing.path("M10,10H370V170H10Z", kWood);
  drawing.path("M10,90H370M190,10V170",
               "fill=\"none\" stroke=\"#111\" stroke-dasharray=\"8 4 2 4\"");
  // A square: its stock on the line across, its blade up to the mark.
  drawing.path("M300,90V28H314V90H344V100H270V90Z", kSteel);
  drawing.circle(300, 40, 5, kHole);
  drawing.measure(190, 112, 300, 112);
  drawing.path("M300,90V118", "fill=\"none\" stroke=\"#111\" stroke-width=\"0.8\"");
  drawing.measure(288, 90, 288, 40);
  drawing.text(245, 129, "x");
  drawing.text(277, 70, "y");
  drawing.text(293, 30, "mark", "end");
  drawing.text(186, 24, "middle line", "end");
  drawing.text(20, 84, "middle line", "start");
  drawing.text(100, 122, "here x has a minus");
  drawing.text(280, 160, "here y has a minus");
  drawing.text(190, 190, "draw both middle lines first; hold the square against them");
  return drawing.finished();
}

/// A tape from hole to hole, its 100 mm mark at the first and its hook hanging free.
std::string draw_tape_and_hook() {
  Drawing drawing("A tape with its 100 mm mark at the first hole and the hook hanging free");
  drawing.path("M10,20H370V150H10Z", kWood);
  drawing.path("M40,70H350V94H40Z", "fill=\"#fdf3c4\" stroke=\"#111\"");
  drawing.path("M40,66V104H34V66Z", "fill=\"#555\" stroke=\"#111\"");
  std::string ticks;
  constexpr double kFirst = 40.0, kStep = 10.0;
  for (int i = 1; i <= 30; ++i)
    ticks += fmt::format("M{:.0f},94V{:.0f}", kFirst + kStep * i, i % 5 == 0 ? 82.0 : 88.0);
  drawing.path(ticks);
  for (const double x : {140.0, 310.0}) {
    drawing.circle(x, 106, 6, kHole);
    drawing.path(fmt::format("M{0:.0f},94V112M{1:.0f},106H{2:.0f}", x, x - 9, x + 9));
  }
  drawing.text(140, 66, "100");
  drawing.text(310, 66, "tape reading");
  drawing.text(37, 60, "hook: free", "start");
  drawing.text(140, 130, "first hole");
  drawing.text(310, 130, "second hole");
  drawing.measure(140, 140, 310, 140);
  drawing.text(190, 170, "from centre to centre; the hook has play, so leave");
  drawing.text(190, 188, "the 100 in and write down the reading");
  return drawing.finished();
}

/// A chain from the pin at 12 o'clock to its end at the ring.
std::string draw_chain_length() {
  Drawing drawing("A chain's length from the pin at 12 o'clock to its end at the ring");
  constexpr double kX = 70.0, kY = 70.0, kRadius = 30.0;
  drawing.circle(kX, kY, kRadius, "fill=\"#e3e7ec\" stroke=\"#111\"");
  std::string teeth;
  for (int i = 0; i < 10; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 10.0 - 0.5 * std::numbers::pi;
    teeth += fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}",
                         kX + kRadius * std::cos(angle),
                         kY + kRadius * std::sin(angle),
                         kX + (kRadius + 6.0) * std::cos(angle),
                         kY + (kRadius + 6.0) * std::sin(angle));
  }
  drawing.path(teeth, "fill=\"none\" stroke=\"#111\" stroke-width=\"3\"");
  drawing.circle(kX, kY - kRadius - 4.0, 4.0, "fill=\"#111\"");
  // From 12 o'clock over the top, then straight to the ring.
  drawing.path("M70,36A34,34 0 0 1 97,49.5L290,130",
               fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"4\"", report::kAfterColor));
  drawing.circle(320, 142, 32, "fill=\"none\" stroke=\"#111\" stroke-width=\"2\"");
  drawing.circle(320, 142, 3, "fill=\"#111\"");
  drawing.path("M290,122V138", "fill=\"none\" stroke=\"#111\" stroke-width=\"2\"");
  drawing.text(70, 20, "pin at 12 o'clock");
  drawing.text(205, 80, "the chain's length", "start");
  drawing.text(282, 152, "its end at the ring", "end");
  drawing.text(320, 190, "sled");
  return drawing.finished();
}

using report::escaped;

constexpr std::string_view kStyle = R"(
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
std::string tables_of(const std::string& head, const std::vector<std::string>& rows) {
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

std::string page_of(const std::string& title,
                    const std::string& bed,
                    const std::string& how,
                    const std::vector<std::string>& steps,
                    const std::string& head,
                    const std::vector<std::string>& rows) {
  std::string list = "<ol>\n";
  for (const std::string& step : steps) list += fmt::format("<li>{}</li>\n", escaped(step));
  list += "</ol>";
  // With this many lines the bed fits over the sheet's whole width.
  constexpr std::size_t kFewLines = 24;
  const std::string top =
      rows.size() <= kFewLines
          ? fmt::format(
                "{}\n<div class=\"drawings\"><div>{}</div><div>{}</div></div>", bed, list, how)
          : fmt::format(
                "<div class=\"drawings\"><div>{}</div><div>{}</div></div>\n{}", bed, how, list);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>{1}</style></head><body>\n<h1>{0}</h1>\n"
      "{2}\n{3}</body></html>\n",
      escaped(title),
      kStyle,
      top,
      tables_of(head, rows));
}

/// The bed as it hangs, numbered marks along the way from one to the next.
std::string drawing_of(const Sheet& sheet, const Bed& bed) {
  constexpr double kDrawingWide = 900.0;
  constexpr double kEdge = 20.0;
  const BedView view(bed.width_mm, bed.height_mm, {kEdge, kEdge}, kDrawingWide);
  const auto x = [&](MarkPoint at) { return view.x(at.x_mm); };
  const auto y = [&](MarkPoint at) { return view.y(at.y_mm); };
  Svg svg(kDrawingWide + 2.0 * kEdge,
          view.high() + 2.0 * kEdge,
          "role=\"img\"",
          "The bed with its numbered marks");
  svg.rectangle(
      kEdge, kEdge, kDrawingWide, view.high(), "fill=\"none\" stroke=\"#111\" stroke-width=\"2\"");
  const std::vector<SheetVisit> visits = visits_of(sheet);
  std::string walk;
  for (const SheetVisit& visit : visits)
    walk += fmt::format("{:.1f},{:.1f} ", x(visit.mark), y(visit.mark));
  svg.add("<polyline fill=\"none\" stroke=\"#999\" stroke-dasharray=\"6 5\" points=\"{}\"/>\n",
          walk);
  // As large as the distance of the nearest two marks allows.
  double nearest = 80.0;
  for (std::size_t i = 0; i < sheet.marks.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      nearest = std::min(nearest,
                         view.scale() * std::hypot(sheet.marks[i].x_mm - sheet.marks[k].x_mm,
                                                   sheet.marks[i].y_mm - sheet.marks[k].y_mm));
    }
  }
  const double radius = std::clamp(0.45 * nearest, 3.0, 16.0);
  for (const SheetVisit& visit : visits) {
    if (visit.again != 0) continue;
    svg.circle(
        x(visit.mark), y(visit.mark), radius, "fill=\"#fff\" stroke=\"#111\" stroke-width=\"1.5\"");
    svg.text(x(visit.mark),
             y(visit.mark) + 0.35 * radius,
             fmt::format("{}", visit.number),
             "middle",
             fmt::format(" font-size=\"{:.1f}\"", radius));
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
                  places ? "sent to " : "",
                  places ? "measured x, mm" : "left chain, mm",
                  places ? "measured y, mm" : "right chain, mm");
  const std::vector<SheetVisit> visits = visits_of(sheet);
  std::vector<std::string> rows;
  for (const SheetVisit& visit : visits) {
    rows.push_back(fmt::format("<tr><td>{}</td><td>{:.0f}</td><td>{:.0f}</td>{}</tr>\n",
                               visit.name(),
                               visit.mark.x_mm + 0.0,
                               visit.mark.y_mm + 0.0,
                               blank_cells(2)));
  }
  std::vector<std::string> steps =
      places ? std::vector<std::string>{
                   "Fasten a sheet to the bed and do not move it until everything is measured. Zero is the middle of the bed, x to the right, y up.",
                   "Send the tool to the marks in numerical order, without any compensation, and mark where it stops (or run the program that drills them).",
                   "Measure x and y of every mark from the sheet's middle lines, to half a millimetre or better."}
             : std::vector<std::string>{
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
  return page_of(
      second == 0
          ? fmt::format("{} marks for {}", sheet.marks.size(), machine.name)
          : fmt::format(
                "{} marks, {} of them twice, for {}", sheet.marks.size(), second, machine.name),
      drawing_of(sheet, machine.bed),
      places ? draw_middle_lines() : draw_chain_length(),
      steps,
      head,
      rows);
}

std::string holes_page(const grid::HolesPlan& plan, const std::string& list) {
  std::vector<std::string> rows;
  for (const grid::HoleDistance& distance : plan.set.distances) {
    rows.push_back(fmt::format("<tr><td>{}</td><td>{}</td><td>{:.0f}</td>{}</tr>\n",
                               escaped(plan.set.holes[distance.from].name),
                               distance.edge ? fmt::format("{} edge", name(*distance.edge))
                                             : escaped(plan.set.holes[distance.to].name),
                               distance.distance_mm,
                               blank_cells(1)));
  }
  return page_of(
      fmt::format("{} holes for {}", plan.set.holes.size(), plan.set.machine->name),
      draw_holes_plan(plan),
      draw_tape_and_hook(),
      {"Fasten a sheet to the bed. Cut the holes with the program, or send the tool to "
       "each; zero is the middle of the bed.",
       "Measure from centre to centre. The hook at the tape's end has play, so hold the 100 mm "
       "mark at the first hole, write down the tape's reading, and fit with --hook-offset-mm 100.",
       "Check every number twice: one misread distance does more harm than a missing hole.",
       typed_into(list)},
      "<th>from</th><th>to</th><th>about, mm</th><th>tape reading, mm</th>",
      rows);
}

}  // namespace chaintrue::cli
