// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/grid_file.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {
namespace {

/// Marks are whole millimetres; adding 0.0 removes the sign of a zero.
std::string whole(double mm) { return fmt::format("{:.0f}", mm + 0.0); }

/// A place of a program, and its name in comments: "hole A".
struct DrillPlace {
  std::string name;
  BedPoint at;
};

/// A rapid above each place, down and up again.
std::string drill_gcode(std::string_view what, const std::vector<DrillPlace>& places,
                        const DrillOptions& options) {
  std::string text = fmt::format(
      "(chaintrue plan: {}, {:g} mm deep)\n(Zero is the middle of the bed. Check that all holes "
      "are on the sheet.)\nG21 G90 G17 G94\nG0 Z{:g}\n",
      what, options.depth_mm, options.clearance_mm);
  for (const DrillPlace& place : places) {
    text +=
        fmt::format("({})\nG0 X{} Y{}\nG1 Z{:g} F150\nG0 Z{:g}\n", place.name, whole(place.at.x_mm),
                    whole(place.at.y_mm), -options.depth_mm, options.clearance_mm);
  }
  return text + "G0 X0 Y0\nM2\n";
}

}  // namespace

double reachable_mm(const Bed& bed) {
  return std::min(kReachableMm, 0.2 * std::min(bed.width_mm, bed.height_mm));
}

void require_margin(OptionProblems& problems, double margin_mm, const Bed& bed,
                    double least_side_mm) {
  const double half = 0.5 * std::min(bed.width_mm, bed.height_mm);
  problems.require("--margin-mm", margin_mm, 0.0, std::max(0.0, half - 0.5 * least_side_mm));
}

std::string SheetVisit::name() const {
  if (again == 0) return fmt::format("{}", number);
  return is_beside ? fmt::format("{} (next to mark {})", number, again)
                   : fmt::format("{} (mark {} again)", number, again);
}

std::vector<SheetVisit> visits_of(const Sheet& sheet) {
  std::vector<std::size_t> order = sheet.visits;
  if (order.empty()) order = grid::numbers_below(sheet.marks.size());
  std::vector<SheetVisit> visits;
  std::vector<std::size_t> first(sheet.marks.size(), 0);
  for (const std::size_t mark : order) {
    const std::size_t number = visits.size() + 1;
    SheetVisit visit{number, sheet.marks.at(mark), first[mark]};
    // A drill follows an existing hole.
    visit.is_beside = visit.again != 0 && sheet.of == SheetOf::places;
    if (visit.is_beside) visit.mark.x_mm += visit.mark.x_mm > 0.0 ? -kBesideMm : kBesideMm;
    visits.push_back(visit);
    if (first[mark] == 0) first[mark] = number;
  }
  return visits;
}

SheetOf sheet_of(const std::string& word, const Machine* machine) {
  if (!word.empty()) return word == "lengths" ? SheetOf::lengths : SheetOf::places;
  const bool is_reported = machine == nullptr || machine->controller.kind == ControllerKind::ideal;
  return is_reported ? SheetOf::lengths : SheetOf::places;
}

std::string sheet_csv(const Sheet& sheet) {
  const bool places = sheet.of == SheetOf::places;
  std::string text = places ? "order,commanded_x_mm,commanded_y_mm,x_mm,y_mm\n"
                            : "order,x_mm,y_mm,left_mm,right_mm\n";
  for (const SheetVisit& visit : visits_of(sheet)) {
    text +=
        fmt::format("{},{},{},,\n", visit.number, whole(visit.mark.x_mm), whole(visit.mark.y_mm));
  }
  return text;
}

std::string sheet_gcode(const Sheet& sheet, const DrillOptions& options) {
  if (sheet.of == SheetOf::places) {
    std::vector<DrillPlace> places;
    for (const SheetVisit& visit : visits_of(sheet)) {
      // A comment in brackets cannot contain further brackets.
      places.push_back({visit.again == 0
                            ? fmt::format("mark {}", visit.number)
                            : fmt::format("mark {}: next to mark {}", visit.number, visit.again),
                        identity_placement(visit.mark)});
    }
    return drill_gcode(fmt::format("{} marks", places.size()), places, options);
  }
  std::string text = fmt::format(
      "(chaintrue plan: {} marks, a stop at each)\n(Zero is the middle of the bed.)\nG21 G90 G17 "
      "G94\nG0 Z{:g}\n",
      visits_of(sheet).size(), options.clearance_mm);
  for (const SheetVisit& visit : visits_of(sheet)) {
    text += fmt::format("G0 X{} Y{}\nM0 (mark {}: write down both chain lengths, then continue)\n",
                        whole(visit.mark.x_mm), whole(visit.mark.y_mm), visit.number);
  }
  return text + "G0 X0 Y0\nM2\n";
}

std::string holes_gcode(const HolesPlan& plan, const DrillOptions& options) {
  const auto places = mapped(plan.set.holes, [](const Hole& hole) {
    return DrillPlace{"hole " + hole.name, hole.commanded};
  });
  return drill_gcode(fmt::format("{} holes", places.size()), places, options);
}

bool is_json_wanted(bool json, const std::string& output) {
  return output == "-" ? json : output.ends_with(".json");
}

namespace {

/// The list as a chaintrue_grid, including the machine and the noise.
std::string sheet_json(const Sheet& sheet, const Machine& machine, const StatedNoise& noise) {
  MeasuredGrid grid;
  grid.name = machine.name;
  grid.machine = machine;
  grid.noise = noise;
  for (const SheetVisit& visit : visits_of(sheet)) {
    grid::MeasuredPoint point;
    point.mark = visit.mark;
    if (sheet.of == SheetOf::places) point.commanded = identity_placement(visit.mark);
    point.order = as_int(visit.number);
    grid.points.push_back(point);
  }
  return files::write_grid_sheet(grid);
}

}  // namespace

Outputs sheet_outputs(const Sheet& sheet, const Machine& machine, const StatedNoise& noise,
                      const PlanOutputs& outputs, const std::string& expected) {
  Outputs written = {
      {outputs.list, is_json_wanted(outputs.json, outputs.list) ? sheet_json(sheet, machine, noise)
                                                                : sheet_csv(sheet)},
      {outputs.page, sheet_page(sheet, machine, outputs.list)},
      {outputs.gcode, sheet_gcode(sheet, outputs.drill)}};
  add_answer(sheet.marks, sheet.visits, expected, outputs, written);
  return written;
}

void add_answer(const std::vector<MarkPoint>& places, const std::vector<std::size_t>& visits,
                const std::string& expected, const PlanOutputs& outputs, Outputs& written) {
  if (!outputs.json || outputs.list == "-") return;
  const auto pairs = mapped(places, [](const MarkPoint& place) {
    return fmt::format("[{}, {}]", place.x_mm, place.y_mm);
  });
  std::vector<std::size_t> order = visits;
  if (order.empty()) order = grid::numbers_below(places.size());
  written.push_back({"-", fmt::format("{{\"marks\": [{}],\n\"visits\": [{}],\n{}}}\n",
                                      fmt::join(pairs, ", "), fmt::join(order, ", "), expected)});
}

void say_next_of_sheet(const PlanOutputs& outputs, const std::string& machine) {
  Words words = {"fit", outputs.list, "-o", "map.json"};
  if (!is_json_wanted(outputs.json, outputs.list))
    words.insert(words.begin() + 2, {"--machine", machine});
  if (outputs.list != "-") say("Write what you read into {}.", outputs.list);
  say_next(words);
}

}  // namespace chaintrue::cli
