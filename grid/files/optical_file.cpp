// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/optical_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/csv_table.hpp"
#include "grid/files/grid_checks.hpp"
#include "grid/files/sources.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr int kRows = 15;
constexpr int kColumns = 31;
constexpr std::size_t kLines = 2 * kRows;
/// A machine with larger errors would not find the square with its camera.
constexpr Range kError{"mm", -500.0, 500.0};

void check_shape(const std::vector<CsvRow>& rows, Problems& problems) {
  const std::string expected = fmt::format(
      "two blocks of {} lines with {} numbers, an empty line between them", kRows, kColumns);
  if (rows.size() != kLines) {
    problems.add("", fmt::format("{} lines of numbers", rows.size()), ProblemKind::bad_table,
                 expected);
  } else if (rows[kRows].front().line == rows[kRows - 1].front().line + 1) {
    problems.add(line_and_column(rows[kRows].front().line, 1), "no empty line before it",
                 ProblemKind::bad_table, expected);
  }
}

void check_width(const CsvRow& row, char separator, Problems& problems) {
  if (row.size() == kColumns) return;
  const bool doubled = separator == ',' && row.size() >= 2 * kColumns - 1;
  problems.add(line_and_column(row.front().line, 1), fmt::format("{} numbers", row.size()),
               ProblemKind::bad_table, "{} numbers{}", kColumns,
               doubled ? " with decimal points; these look like decimal commas" : "");
}

/// The lines of both blocks.
std::vector<CsvRow> read_rows(const std::string& text, Problems& problems) {
  const char separator = separator_of(text);
  std::vector<CsvRow> rows = split_csv(text, separator, problems);
  if (rows.empty())
    problems.add("", "an empty file", ProblemKind::empty_file,
                 "the scan written by an optical calibration");
  problems.throw_if_any();
  check_shape(rows, problems);
  for (CsvRow& row : rows) {
    if (row.size() > 1 && row.back().text.empty()) row.pop_back();
    check_width(row, separator, problems);
  }
  return rows;
}

/// Positions and errors are decimals, and so are their sums and products: rounded to a nanometre,
/// which removes the error of binary fractions.
double as_decimal(double value_mm) { return std::round(value_mm * 1e6) / 1e6; }

/// The number of a square's visit if all squares had been visited; distinct and in the order of the
/// visits.
int visit(const VisitingOrder& order, int row, int column) {
  const int outer = order.rows ? row : column;
  const int inner = order.rows ? column : row;
  const int length = order.rows ? kColumns : kRows;
  return outer * length + (order.serpentine && outer % 2 == 1 ? length - 1 - inner : inner);
}

/// Numbers the visited squares from 0 without gaps.
void number_visits(std::vector<MeasuredPoint>& points) {
  const std::vector<MeasuredPoint> all = points;
  for (MeasuredPoint& point : points) {
    point.order = as_int(count_where(
        all, [order = point.order](const MeasuredPoint& other) { return other.order < order; }));
  }
}

}  // namespace

MeasuredGrid parse_optical(const std::string& text, const std::string& file,
                           const OpticalOptions& options) {
  Problems problems(file);
  if (options.machine.controller.kind == ControllerKind::ideal) {
    problems.add("the machine's /controller", "", ProblemKind::missing,
                 "the controller that executed the commands (\"kind\": \"maslow_classic\", "
                 "\"holey\" or \"fluidnc_wallplotter\") and its settings");
  }
  const std::vector<CsvRow> rows = read_rows(text, problems);
  const auto errors = mapped(rows, [&](const CsvRow& row) {
    const char* name = &row < rows.data() + kRows ? "error in x" : "error in y";
    return mapped(row, [&](const CsvCell& cell) {
      return checked_number(cell.text, cell.place(), name, kError, problems).value_or(0.0);
    });
  });
  problems.throw_if_any();
  MeasuredGrid grid;
  grid.name = name_without_folders(file);
  grid.machine = options.machine;
  grid.sheet = SheetUncertainty{};
  Words lines;
  for (const int row : each_below(kRows)) {
    for (const int column : each_below(kColumns)) {
      const double in_x = errors[as_size(row)][as_size(column)];
      const double in_y = errors[as_size(row + kRows)][as_size(column)];
      if (in_x == 0.0 && in_y == 0.0) continue;
      MeasuredPoint& point = grid.points.emplace_back();
      point.mark = {as_decimal((column - kColumns / 2) * options.pitch_mm),
                    as_decimal((kRows / 2 - row) * options.pitch_mm)};
      point.commanded = {as_decimal(point.mark.x_mm + in_x), as_decimal(point.mark.y_mm + in_y)};
      if (options.order) point.order = visit(*options.order, row, column);
      lines.push_back(
          fmt::format("line {}, number {}", rows[as_size(row)].front().line, column + 1));
    }
  }
  if (options.order) number_visits(grid.points);
  const PointPlaces places{"the visited squares",
                           [&lines](std::size_t index, std::string_view) { return lines[index]; }};
  check_points_together(grid, kFewestPoints, places, problems);
  problems.throw_if_any();
  return grid;
}

}  // namespace chaintrue::grid::files
