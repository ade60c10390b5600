// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A small CSV of numbers under a header line. Private to grid/files. Accepts what spreadsheets
/// write: a byte order mark, CRLF, semicolons or tabs, quoted cells, blank lines, trailing
/// separators, a first line `sep=;`, words above the header and below the last row, unknown
/// columns, a dash for no reading, decimal commas and groups of thousands; lines that begin with #
/// are comments. A column may be headed `X (mm)` or `x in`, in inches. Numbers are read independent
/// of the locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/csv_lines.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

/// How to give lengths between places, for messages about tables that hold such.
inline constexpr std::string_view kLengthsBetween =
    "write lengths between places below from_x_mm,from_y_mm,to_x_mm,to_y_mm,distance_mm, one per "
    "line: -300,0,300,0,604 if 600 was commanded and 604 was cut";

/// The names of the columns, by the header: in small letters, `X (mm)` and `x_in` as x_mm.
std::vector<std::string> csv_header(std::string_view text);
struct CsvColumn {
  std::string name;
  Range range;
  bool is_required = true;
  /// For a required column: cells may be empty, as in a sheet that is not filled in.
  bool may_be_blank = false;
  /// The factor to the range's unit for numbers without a unit, unless the header states one.
  double unit = 1.0;
  /// Its cells are words, and have no values.
  bool is_text = false;
};

/// Of a row, in the order of `columns`.
struct CsvLine {
  /// Absent for empty cells of columns that allow them.
  std::vector<std::optional<double>> values;
  /// The cell of each value, for messages; an empty place if there is none.
  CsvRow cells;
  bool is_clean = false;  ///< false: a problem of it is reported
};

/// Reads rows whose first one, the header, names `columns`, in any order. Every problem is added; all
/// rows that could be split are returned.
std::vector<CsvLine> read_table(std::vector<CsvRow> rows, const std::vector<CsvColumn>& columns,
                                Problems& problems);
/// The same, of a text that is one table; a problem if there is no row.
std::vector<CsvLine> read_csv(std::string_view text, const std::vector<CsvColumn>& columns,
                              Problems& problems);

}  // namespace chaintrue::grid::files
