// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers in the cells of a table, as written by people and by spreadsheets of any country:
/// decimal commas, groups of thousands, long minus signs, spaces that do not break, a dash for no
/// reading. Private to grid/files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/files/csv_lines.hpp"

namespace chaintrue::grid::files {

/// Long minus signs before digits become `-`, spaces that do not break go from between thousands and
/// become spaces elsewhere.
[[nodiscard]] std::string with_plain_signs(std::string_view text);

/// A number in one of these ways of writing, a unit behind it or not.
[[nodiscard]] bool is_like_a_number(std::string_view text);

/// `-`, `n/a`, `?`: nothing was read.
[[nodiscard]] bool stands_for_nothing(std::string_view text);

/// Decimal commas become points, and groups of thousands are joined, if the file as a whole is
/// unambiguous: if commas separate cells, `"555,5"` must occur, not only `"1,113"`; if any number
/// has a decimal point, all commas except those of thousands are unchanged.
void write_decimal_points(char separator, std::vector<CsvRow>& rows);

}  // namespace chaintrue::grid::files
