// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Formatting of numbers and texts for a document's renderers.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "tools/report/document.hpp"

namespace chaintrue::report {

using Replacement = std::pair<std::string_view, std::string_view>;
/// Replaces every occurrence of each pair's first text by its second, one pair after the other.
std::string replaced(std::string text, std::initializer_list<Replacement> replacements);
std::string capitalised(std::string text);
/// For a page: +- as one sign, without a line break after it.
std::string typeset(std::string text);
/// A number with U+2212 in place of the ASCII sign.
[[nodiscard]] std::string with_true_minus(std::string number);
/// Fixed digits with a true minus sign, never "-0.00".
std::string fixed(double value, int digits);
/// The number of a column, with an ASCII sign; never "-0.00".
/// \throws std::invalid_argument if it is not finite.
std::string number_of(double value, const Column& column);
/// The text of a cell, or its number.
std::string typed(const Cell& cell, const Column& column, const char* unknown = "");
/// A row's cells, at most as many as the table has columns. \throws std::invalid_argument for more.
void check_row(const Table& table, const Row& row);

/// For text between tags and in quoted attributes; invalid UTF-8 becomes the replacement character,
/// since file names are bytes.
std::string escaped(std::string_view bytes);

}  // namespace chaintrue::report
