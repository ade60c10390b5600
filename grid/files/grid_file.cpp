// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/grid_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/csv_table.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/grid_checks.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/records.hpp"
#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr int kLargestOrder = 1'000'000'000;

/// The content of the file, before the machine is read and the points are checked together.
struct StatedGrid : MeasuredGrid {
  std::string machine_file;
  std::vector<StatedPoint> lines;
};

auto noise_record() {
  RECORD(StatedNoise, "the noise")
  REQUIRED(length_mm, "Noise of a chain reading, 1 sigma.", kNoiseMm)
  REQUIRED(position_mm, "Noise of a mark's position, 1 sigma on each axis.", kNoiseMm)
  OPTIONAL(dof, "Degrees of freedom with which these are known; 15 means to about a fifth.",
           kNoiseDof);
}

auto sheet_uncertainty_record() {
  RECORD(SheetUncertainty, "the sheet's placement")
  REQUIRED(shift_mm, "Uncertainty of the sheet's position, 1 sigma on each axis.",
           {"mm", 0.0, 1000.0})
  REQUIRED(rotation_mrad, "Uncertainty of the sheet's rotation, 1 sigma.", {"mrad", 0.0, 500.0});
}

const Record<StatedPoint>& point_record() {
  static const auto record = [] {
    RECORD(StatedPoint, "a point")
    REQUIRED(x_mm, "x of the tool. Null in a list that is not filled in yet.", kCoordinateMm)
    REQUIRED(y_mm, "y of the tool, up. Null in a list that is not filled in yet.", kCoordinateMm)
    OPTIONAL(left_mm, "Length of the left chain, as read or as commanded.", kLengthMm)
    OPTIONAL(right_mm, "Length of the right chain, as read or as commanded.", kLengthMm)
    OPTIONAL(commanded_x_mm,
             "Commanded x; the chain lengths are then those of the controller's kinematics.",
             kCoordinateMm)
    OPTIONAL(commanded_y_mm, "Commanded y, up.", kCoordinateMm)
    OPTIONAL(order, "Number of the visit. Either all points have one, all different, or none has.",
             integer(0, kLargestOrder));
  }();
  return record;
}

/// A point has lengths, or the command it was sent to; null is a value that was not read.
Json points_schema() {
  Json point = point_record().schema();
  for (const char* key : {"x_mm", "y_mm"}) point["properties"][key]["type"] = {"number", "null"};
  point["anyOf"] = {{{"required", {"left_mm", "right_mm"}}},
                    {{"required", {"commanded_x_mm", "commanded_y_mm"}}}};
  return list_schema(point, 0);
}

/// A point of a list to fill in: a mark with null for both lengths, or a command with null for both
/// coordinates.
bool is_blank(const Cursor& at) {
  const auto is_null = [&at](const char* key) {
    return at.has(key) && at.child(key).json().is_null();
  };
  if (!at.json().is_object()) return false;
  return at.has("commanded_x_mm") ? is_null("x_mm") && is_null("y_mm")
                                  : is_null("left_mm") && is_null("right_mm");
}

/// Like list(object(point_record())), and records which points were wrong and which left blank.
void read_points(const Cursor& at, StatedGrid& grid) {
  if (!at.json().is_array()) return at.expect("a list of points");
  for (std::size_t i = 0; i < at.json().size(); ++i) {
    const std::size_t problems_before = at.problems().list().size();
    StatedPoint point;
    if (is_blank(at.element(i))) {
      point.is_blank = true;
      point.order = at.element(i).has("order")
                        ? integer(0, kLargestOrder).read(at.element(i).child("order"))
                        : std::nullopt;
    } else {
      point = point_record().read(at.element(i)).value_or(StatedPoint{});
    }
    point.is_spoilt = at.problems().list().size() > problems_before;
    grid.lines.push_back(point);
  }
}

const Record<StatedGrid>& grid_record() {
  static const auto record = [] {
    RECORD(StatedGrid, "a grid", kGridFormat)
    OPTIONAL(name, "Name of the session in messages and pages.")
    OPTIONAL(machine, "The machine with its settings in force; or machine_file.", machine_record())
    SPARSE(machine_file, "Path of the machine file, from this file.")
    OPTIONAL(noise,
             "Noise of the readings. Missing values are estimated from repeated visits, or "
             "assumed; none is taken below the rounding of the readings.",
             noise_record())
    OPTIONAL(sheet, "How accurately the marks' sheet was placed by hand; absent: exactly.",
             sheet_uncertainty_record())
    SPARSE(readings, "What was measured besides the points.", reading_record())
    FIELD(
        custom, "points", "The measured points.", true, {"a list of points", points_schema},
        read_points,
        [value = list(point_record())](const StatedGrid& grid) { return value.write(grid.lines); })
        .schema_also({{"not", {{"required", {"machine", "machine_file"}}}}})
        .check([](const Cursor& at, StatedGrid& grid) {
          if (grid.machine && !grid.machine_file.empty()) {
            at.child("machine_file").expect("either \"machine\" or \"machine_file\", not both");
          }
        });
  }();
  return record;
}

/// The common part of JSON and CSV, once the fields are read.
ReadGrid finish(StatedGrid grid, PointPlaces places, const MeasuredOptions& options,
                Problems& problems) {
  std::vector<std::string> blanks;
  for (const StatedPoint& point : grid.lines) {
    const int number = point.order.value_or(static_cast<int>(blanks.size()) + 1);
    blanks.push_back(point.is_blank ? fmt::format("{}", number) : "");
  }
  constexpr EntryWords kWords{"points", "the readings, written into the empty columns"};
  keep_only(filled_in(blanks, kWords, places.all, problems), grid.lines, places.of);
  count_copies_once(grid.lines, places, problems);
  fetch_machine(grid.machine, grid.machine_file, options, problems);
  const bool points_are_whole =
      none_of(grid.lines, [](const StatedPoint& point) { return point.is_spoilt; });
  const std::size_t problems_before = problems.list().size();
  grid.points = measured_points(grid.lines, places, problems);
  if (points_are_whole && problems.list().size() == problems_before)
    check_points_together(grid, options.few ? 1 : kFewestPoints, places, problems);
  problems.throw_if_any();
  warn_of_copies(grid, places, problems);
  warn_of_repeats_that_disagree(grid, places, problems);
  return {std::move(grid), problems.warnings()};
}

ReadGrid parse_json_grid(const std::string& text, const MeasuredOptions& options,
                         Problems& problems) {
  const Json json = parse_json(text, problems);
  auto stated = grid_record().read(Cursor(json, problems), true);
  const bool has_points = json.is_object() && json.contains("points") && json["points"].is_array();
  if (!stated || !has_points) problems.throw_if_any();
  const PointPlaces places{"/points", place_in_json("/points")};
  return finish(std::move(stated.value()), places, options, problems);
}

/// A row without any of its readings is blank; one with half of them is reported.
void take_blanks(const CsvTable& table, std::size_t i, bool commanded, StatedPoint& point,
                 Problems& problems) {
  if (point.is_spoilt) return;
  const std::size_t first = commanded ? 0 : 2;  // columns x_mm and y_mm, or left_mm and right_mm
  const auto& row = table.rows[i];
  if (row[first] && row[first + 1]) return;
  point.is_blank = !row[first] && !row[first + 1];
  if (point.is_blank) return;
  point.is_spoilt = true;
  constexpr const char* kNames[] = {"x_mm", "y_mm", "left_mm", "right_mm"};
  const std::size_t missing = row[first] ? first + 1 : first;
  const Range& range = commanded ? kCoordinateMm : kLengthMm;
  problems.add(table.cells[i][missing].place(), "", ProblemKind::left_blank,
               "{} ({}), or both left blank", range.expected(), kNames[missing]);
}

ReadGrid parse_csv_grid(const std::string& text, const MeasuredOptions& options,
                        Problems& problems) {
  constexpr std::size_t kOrder = 4;
  // Lengths are required unless the header has commands in their place.
  const std::vector<std::string> header = csv_header(text);
  const bool commanded =
      any_of(header, [](const std::string& name) { return name.rfind("commanded_", 0) == 0; });
  const double unit = options.inches ? input_checks::kMmPerInch : 1.0;
  const std::vector<CsvColumn> columns = {{"x_mm", kCoordinateMm, true, commanded, unit},
                                          {"y_mm", kCoordinateMm, true, commanded, unit},
                                          {"left_mm", kLengthMm, !commanded, true, unit},
                                          {"right_mm", kLengthMm, !commanded, true, unit},
                                          {"order", {"", 0.0, kLargestOrder}, false},
                                          {"commanded_x_mm", kCoordinateMm, commanded},
                                          {"commanded_y_mm", kCoordinateMm, commanded}};
  const CsvTable table = read_csv(text, columns, problems);
  StatedGrid stated;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    StatedPoint point{
        row[0].value_or(0.0), row[1].value_or(0.0), row[2], row[3], row[5], row[6], {},
        !table.clean[i]};
    take_blanks(table, i, commanded, point, problems);
    if (row[kOrder]) {
      if (*row[kOrder] == std::floor(*row[kOrder])) {
        point.order = static_cast<int>(*row[kOrder]);
      } else {
        point.is_spoilt = true;
        const CsvCell& cell = table.cells[i][kOrder];
        problems.add(cell.place(), cell.text, ProblemKind::not_a_number, "a whole number (order)");
      }
    }
    stated.lines.push_back(point);
  }
  if (table.rows.empty()) {
    if (!problems.any())
      problems.add("", "a header line only", ProblemKind::empty_file,
                   "at least one line of numbers below it");
    problems.throw_if_any();
  }
  const PointPlaces places{
      "the points",
      [&table](std::size_t index, std::string_view field) {
        const CsvRow& cells = table.cells[index];
        return field == "order" && !cells[kOrder].text.empty() ? cells[kOrder].place()
                                                               : cells.front().place();
      },
      options.inches ? input_checks::Written::in_json : input_checks::Written::in_table};
  return finish(std::move(stated), places, options, problems);
}

}  // namespace

ReadGrid parse_grid(const std::string& text, const std::string& file,
                    const MeasuredOptions& options) {
  Problems problems(file);
  return is_json(text) ? parse_json_grid(text, options, problems)
                       : parse_csv_grid(text, options, problems);
}

namespace {

StatedGrid stated_grid(const MeasuredGrid& grid) {
  StatedGrid stated{grid, {}, {}};
  for (const MeasuredPoint& point : grid.points) {
    StatedPoint to{point.mark.x_mm, point.mark.y_mm, {}, {}, {}, {}, point.order};
    if (point.lengths) {
      to.left_mm = point.lengths->left_mm;
      to.right_mm = point.lengths->right_mm;
    }
    if (point.commanded) {
      to.commanded_x_mm = point.commanded->x_mm;
      to.commanded_y_mm = point.commanded->y_mm;
    }
    stated.lines.push_back(to);
  }
  return stated;
}

}  // namespace

std::string write_grid(const MeasuredGrid& grid) {
  return write_document(grid_record(), stated_grid(grid));
}

std::string write_grid_sheet(const MeasuredGrid& plan) {
  Json json = grid_record().write(stated_grid(plan));
  for (Json& point : json["points"]) {
    const bool commanded = point.contains("commanded_x_mm");
    point[commanded ? "x_mm" : "left_mm"] = nullptr;
    point[commanded ? "y_mm" : "right_mm"] = nullptr;
  }
  return print_json(json);
}

Json grid_schema() { return grid_record().schema(); }

}  // namespace chaintrue::grid::files
