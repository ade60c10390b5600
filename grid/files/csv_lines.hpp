// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lines of a CSV that hold cells, cut into these. Private to grid/files. A byte order mark, CRLF,
/// a first line `sep=;`, blank lines, comments behind # and the words above the header are left out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

struct CsvCell {
  std::string text;
  std::size_t line = 0;
  std::size_t column = 0;
  std::string place() const { return line_and_column(line, column); }
};

using CsvRow = std::vector<CsvCell>;

/// The lines that are neither blank nor comments, cut at `separator`. Blanks around cells and
/// quotes are removed, and numbers are written with a point if the meaning of the file's commas is
/// certain. A title above the header is a warning.
/// \throws InputError for a table with more cells than any supported format has
std::vector<CsvRow> split_csv(std::string_view text, char separator, Problems& problems);
/// The header alone.
CsvRow header_of_csv(std::string_view text);

/// The most frequent of comma, semicolon and tab in the header; a comma if it has none.
char separator_of(std::string_view text);

// Numbers in the cells of a table, as written by people and by spreadsheets of any country:
// decimal commas, groups of thousands, long minus signs, spaces that do not break, a dash for no
// reading. Private to grid/files.

/// A number in one of these ways of writing, a unit behind it or not.
bool is_like_a_number(std::string_view text);

/// `-`, `n/a`, `?`: nothing was read.
bool stands_for_nothing(std::string_view text);

}  // namespace chaintrue::grid::files
