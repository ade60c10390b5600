// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A small CSV of numbers under a header line. Private to grid/files. Accepts what spreadsheets
/// write: a byte order mark, CRLF, semicolons or tabs, quoted cells, blank lines, trailing
/// separators, a first line `sep=;`, words below the last row, columns that nobody asked for; lines
/// that begin with # are comments. A column may be headed `X (mm)` or `x in`, in inches. Numbers are read independent of the locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/number_text.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

struct CsvCell {
  std::string text;
  std::size_t line = 0;
  std::size_t column = 0;
  [[nodiscard]] std::string place() const { return line_and_column(line, column); }
};

using CsvRow = std::vector<CsvCell>;

/// The lines that are neither blank nor comments, cut at `separator`. Blanks around cells and
/// quotes are removed. Where no comma separates and no number has a point, decimal commas become
/// points.
[[nodiscard]] std::vector<CsvRow> split_csv(std::string_view text,
                                            char separator,
                                            Problems& problems);
/// The names of the columns, by the first line that is neither blank nor a comment: in small letters,
/// `X (mm)` and `x_in` as x_mm.
[[nodiscard]] std::vector<std::string> csv_header(std::string_view text);
/// Of comma, semicolon and tab the one that the first line with cells has most of; a comma where
/// there is none.
[[nodiscard]] char separator_of(std::string_view text);
struct CsvColumn {
  std::string name;
  Range range;
  bool is_required = true;
  /// For a required column: cells may be empty, as in a sheet that is not filled in.
  bool may_be_blank = false;
  /// What a number without a unit of its own is in the range's unit, where the header says no other.
  double unit = 1.0;
};

/// Rows of numbers by column, in the order of `columns`; absent for empty cells of columns that
/// allow them.
struct CsvTable {
  std::vector<std::vector<std::optional<double>>> rows;
  /// The cell of each value, for messages; an empty place where there is none.
  std::vector<CsvRow> cells;
  /// False for a row with a problem.
  std::vector<bool> clean;
};

/// The number of a cell that is not empty, in the range's unit; `unit` is that of a bare number. A
/// problem is added where it is none, or out of range.
[[nodiscard]] std::optional<double> number_in_unit(const CsvCell& cell,
                                                   double unit,
                                                   std::string_view name,
                                                   const Range& range,
                                                   Problems& problems);

/// Reads text whose header names `columns`, in any order. Every problem is added; all rows that
/// could be split are returned.
[[nodiscard]] CsvTable read_csv(std::string_view text,
                                const std::vector<CsvColumn>& columns,
                                Problems& problems);

}  // namespace chaintrue::grid::files
