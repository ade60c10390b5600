// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/optical_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/csv_table.hpp"
#include "grid/files/grid_checks.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/sources.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr int kRows = 15;
constexpr int kColumns = 31;
constexpr std::size_t kLines = 2 * kRows;
/// A machine with larger errors would not find the square with its camera.
constexpr Range kError{"mm", -500.0, 500.0};

using Block = std::array<std::array<double, kColumns>, kRows>;

struct Blocks {
  Block x{};
  Block y{};
  /// The line of each row of the first block, for messages.
  std::array<std::size_t, kRows> lines{};
};

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

Blocks read_blocks(const std::string& text, Problems& problems) {
  Blocks blocks;
  const char separator = separator_of(text);
  std::vector<CsvRow> rows = split_csv(text, separator, problems);
  if (rows.empty())
    problems.add("", "an empty file", ProblemKind::empty_file,
                 "the scan written by an optical calibration");
  problems.throw_if_any();
  check_shape(rows, problems);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    CsvRow& row = rows[r];
    if (row.size() > 1 && row.back().text.empty()) row.pop_back();
    check_width(row, separator, problems);
    for (std::size_t c = 0; c < row.size(); ++c) {
      const char* name = r < kRows ? "error in x" : "error in y";
      const auto value = checked_number(row[c].text, row[c].place(), name, kError, problems);
      if (r >= kLines || c >= kColumns) continue;
      (r < kRows ? blocks.x[r] : blocks.y[r - kRows])[c] = value.value_or(0.0);
    }
    if (r < kRows) blocks.lines[r] = row.front().line;
  }
  return blocks;
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
void number_visits(std::vector<StatedPoint>& points) {
  std::vector<StatedPoint*> in_order;
  for (StatedPoint& point : points) in_order.push_back(&point);
  sort(in_order, [](const StatedPoint* a, const StatedPoint* b) { return *a->order < *b->order; });
  for (std::size_t i = 0; i < in_order.size(); ++i) in_order[i]->order = static_cast<int>(i);
}

void check_options(const OpticalOptions& options, Problems& problems) {
  if (!kOpticalPitchMm.holds(options.pitch_mm)) {
    problems.add("--pitch-mm", fmt::format("{}", options.pitch_mm), ProblemKind::out_of_range,
                 kOpticalPitchMm.expected());
  }
  if (options.machine.controller.kind == model::ControllerKind::ideal) {
    problems.add("the machine's /controller", "", ProblemKind::missing,
                 "the controller that executed the commands (\"kind\": \"maslow_classic\", "
                 "\"holey\" or \"fluidnc_wallplotter\") and its settings");
  }
}

}  // namespace

ReadOptical parse_optical(const std::string& text, const std::string& file,
                          const OpticalOptions& options) {
  Problems problems(file);
  check_options(options, problems);
  const Blocks blocks = read_blocks(text, problems);
  problems.throw_if_any();
  std::vector<StatedPoint> stated;
  std::vector<std::string> lines;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const auto r = as_size(row);
      const auto c = as_size(column);
      if (blocks.x[r][c] == 0.0 && blocks.y[r][c] == 0.0) continue;
      StatedPoint point;
      point.x_mm = as_decimal((column - kColumns / 2) * options.pitch_mm);
      point.y_mm = as_decimal((kRows / 2 - row) * options.pitch_mm);
      point.commanded_x_mm = as_decimal(point.x_mm + blocks.x[r][c]);
      point.commanded_y_mm = as_decimal(point.y_mm + blocks.y[r][c]);
      if (options.order) point.order = visit(*options.order, row, column);
      stated.push_back(point);
      lines.push_back(fmt::format("line {}, number {}", blocks.lines[r], column + 1));
    }
  }
  if (options.order) number_visits(stated);
  ReadOptical read;
  read.squares = kRows * kColumns;
  read.grid.name = name_without_folders(file);
  read.grid.machine = options.machine;
  read.grid.sheet = SheetUncertainty{};
  const PointPlaces places{"the visited squares",
                           [&lines](std::size_t index, std::string_view) { return lines[index]; }};
  read.grid.points = measured_points(stated, places, problems);
  check_points_together(read.grid, kFewestPoints, places, problems);
  problems.throw_if_any();
  return read;
}

}  // namespace chaintrue::grid::files
