// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/grid_file.hpp"

#include <fmt/format.h>


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
  std::vector<EnteredPoint> lines;
};

auto noise_record() {
  RECORD(StatedNoise, "the noise")
  REQUIRED(length_mm, "Noise of a chain reading, 1 sigma.", kNoiseMm)
  REQUIRED(position_mm, "Noise of a mark's position, 1 sigma on each axis.", kNoiseMm)
  OPTIONAL(dof, "Degrees of freedom with which these are known; 15 means to about a fifth.",
           kNoiseDof);
}

RECORD_OF(SheetUncertainty, "the sheet's placement")
REQUIRED(shift_mm, "Uncertainty of the sheet's position, 1 sigma on each axis.",
         {"mm", 0.0, 1000.0})
REQUIRED(rotation_mrad, "Uncertainty of the sheet's rotation, 1 sigma.", {"mrad", 0.0, 500.0})
END_RECORD;

/// `stands`: which of left_mm, right_mm, commanded_x_mm and commanded_y_mm a point has.
void check_parts(const std::array<bool, 4>& stands, const std::string& place, Problems& problems) {
  const auto& [left, right, x, y] = stands;
  if ((left || right) && (x || y)) {
    problems.add(place, "both lengths and a command", ProblemKind::contradiction,
                 "either left_mm and right_mm, or commanded_x_mm and commanded_y_mm");
  } else if (left != right) {
    problems.add(place, left ? "left_mm without right_mm" : "right_mm without left_mm",
                 ProblemKind::missing, "both lengths");
  } else if (x != y) {
    problems.add(
        place,
        x ? "commanded_x_mm without commanded_y_mm" : "commanded_y_mm without commanded_x_mm",
        ProblemKind::missing, "both coordinates of the command");
  } else if (!left && !x) {
    problems.add(place, "neither lengths nor a command", ProblemKind::missing,
                 "left_mm and right_mm, or commanded_x_mm and commanded_y_mm");
  }
}

const Record<MeasuredPoint>& point_record() {
  KEPT_RECORD(MeasuredPoint, "a point")
  FIELD(place, &Own::mark, "x of the tool. Null in a list that is not filled in yet.",
        "y of the tool, up. Null in a list that is not filled in yet.", kCoordinateMm)
  NESTED(optional, "left_mm", lengths, left_mm,
         "Length of the left chain, as read or as commanded.", kLengthMm)
  NESTED(optional, "right_mm", lengths, right_mm,
         "Length of the right chain, as read or as commanded.", kLengthMm)
  NESTED(optional, "commanded_x_mm", commanded, x_mm,
         "Commanded x; the chain lengths are then those of the controller's kinematics.",
         kCoordinateMm)
  NESTED(optional, "commanded_y_mm", commanded, y_mm, "Commanded y, up.", kCoordinateMm)
  OPTIONAL(order, "Number of the visit. Either all points have one, all different, or none has.",
           integer(0, kLargestOrder))
      .check([](const Cursor& at, Own&) {
        if (at.clean())
          check_parts({!at.is_null("left_mm"), !at.is_null("right_mm"),
                       !at.is_null("commanded_x_mm"), !at.is_null("commanded_y_mm")},
                      at.pointer(), at.problems());
      });
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
  if (!at.json().is_array()) return (void)at.expect("a list of points");
  for (const auto i : each_index(at.json())) {
    const std::size_t problems_before = at.problems().list().size();
    EnteredPoint& entered = grid.lines.emplace_back();
    entered.is_blank = is_blank(at.element(i));
    if (!entered.is_blank) {
      entered.point = point_record().read(at.element(i)).value_or(MeasuredPoint{});
    } else if (at.element(i).has("order")) {
      entered.point.order = integer(0, kLargestOrder).read(at.element(i).child("order"));
    }
    entered.is_spoilt = at.problems().list().size() > problems_before;
  }
}

}  // namespace

FILE_RECORD(grid, StatedGrid, "a grid", kGridFormat)
OPTIONAL(name, "Name of the session in messages and pages.")
OPTIONAL(machine, "The machine with its settings in force; or machine_file.", machine_record())
SPARSE(machine_file, "Path of the machine file, from this file.")
OPTIONAL(noise,
         "Noise of the readings. Missing values are estimated from repeated visits, or "
         "assumed; none is taken below the rounding of the readings.",
         noise_record())
OPTIONAL(sheet, "How accurately the marks' sheet was placed by hand; absent: exactly.")
SPARSE(readings, "What was measured besides the points.", reading_record())
FIELD(custom, "points", "The measured points.", true, {"a list of points", points_schema()},
      read_points,
      [value = list(point_record())](const StatedGrid& grid) { return value.write(grid.points); })
    .schema_also({{"not", {{"required", {"machine", "machine_file"}}}}})
    .check([](const Cursor& at, StatedGrid& grid) {
      if (grid.machine && !grid.machine_file.empty()) {
        at.child("machine_file").expect("either \"machine\" or \"machine_file\", not both");
      }
    }) END_FILE_RECORD;

namespace {

/// The common part of JSON and CSV, once the fields are read.
ReadGrid finish(StatedGrid grid, PointPlaces places, const MeasuredOptions& options,
                Problems& problems) {
  Words blanks;
  for (const EnteredPoint& entered : grid.lines) {
    const int number = entered.point.order.value_or(as_int(blanks.size()) + 1);
    blanks.push_back(entered.is_blank ? fmt::format("{}", number) : "");
  }
  keep_only(filled_in(blanks, "points", "the readings, written into the empty columns", places.all,
                      problems),
            grid.lines, places.of);
  count_copies_once(grid.lines, places, problems);
  fetch_machine(grid.machine, grid.machine_file, options, problems);
  std::vector<StatedOrder> orders;
  for (const EnteredPoint& entered : grid.lines) {
    grid.points.push_back(entered.point);
    orders.push_back({entered.point.order, entered.is_spoilt});
  }
  const std::size_t problems_before = problems.list().size();
  check_orders(orders, places.of, problems);
  const bool points_are_whole = none_of(orders, &StatedOrder::is_spoilt);
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
void take_blanks(const CsvLine& line, const std::vector<CsvColumn>& columns, bool commanded,
                 EnteredPoint& point, Problems& problems) {
  const std::size_t first = commanded ? 0 : 2;  // columns x_mm and y_mm, or left_mm and right_mm
  const bool has_first = line.values[first].has_value();
  const bool has_second = line.values[first + 1].has_value();
  point.is_blank = !has_first && !has_second;
  if (has_first == has_second) return;
  const std::size_t missing = has_first ? first + 1 : first;
  problems.add(line.cells[missing].place(), "", ProblemKind::left_blank,
               "{} ({}), or both left blank", columns[missing].range.expected(),
               columns[missing].name);
}

ReadGrid parse_csv_grid(const std::string& text, const MeasuredOptions& options,
                        Problems& problems) {
  constexpr std::size_t kOrder = 4;
  // Lengths are required unless the header has commands in their place.
  const Words header = csv_header(text);
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
  const std::vector<CsvLine> lines = read_csv(text, columns, problems);
  if (lines.empty()) problems.throw_if_any();
  StatedGrid stated;
  for (const CsvLine& line : lines) {
    const auto& row = line.values;
    EnteredPoint& entered = stated.lines.emplace_back();
    MeasuredPoint& point = entered.point;
    point.mark = {row[0].value_or(0.0), row[1].value_or(0.0)};
    if (row[2] && row[3]) point.lengths = {*row[2], *row[3]};
    if (row[5] && row[6]) point.commanded = {*row[5], *row[6]};
    const std::size_t problems_before = problems.list().size();
    if (line.is_clean) take_blanks(line, columns, commanded, entered, problems);
    if (line.is_clean && !entered.is_blank && problems.list().size() == problems_before) {
      check_parts({row[2].has_value(), row[3].has_value(), row[5].has_value(), row[6].has_value()},
                  line.cells.front().place(), problems);
    }
    const CsvCell& order = line.cells[kOrder];
    if (row[kOrder]) point.order = whole_number_of(order.text, 0, kLargestOrder);
    if (row[kOrder] && !point.order)
      problems.add(order.place(), order.text, ProblemKind::not_a_number, "a whole number (order)");
    entered.is_spoilt = !line.is_clean || problems.list().size() > problems_before;
  }
  const PointPlaces places{
      "the points",
      [&lines](std::size_t index, std::string_view field) {
        const CsvRow& cells = lines[index].cells;
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

std::string write_grid(const MeasuredGrid& grid) {
  return write_document(grid_record(), {grid, {}, {}});
}

std::string write_grid_sheet(const MeasuredGrid& plan) {
  Json json = grid_record().write({plan, {}, {}});
  for (Json& point : json["points"]) {
    const bool commanded = point.contains("commanded_x_mm");
    point[commanded ? "x_mm" : "left_mm"] = nullptr;
    point[commanded ? "y_mm" : "right_mm"] = nullptr;
  }
  return print_json(json);
}

}  // namespace chaintrue::grid::files
