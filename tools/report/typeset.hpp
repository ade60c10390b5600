// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Formatting of numbers and texts for a document's renderers.
#pragma once

#include <string>
#include <string_view>

#include "tools/report/document.hpp"

namespace chaintrue::report {

[[nodiscard]] std::string capitalised(std::string text);
/// For a page: +- as one sign, without a line break after it.
[[nodiscard]] std::string typeset(std::string text);
/// Fixed digits with a true minus sign, never "-0.00".
[[nodiscard]] std::string fixed(double value, int digits);
/// The number of a column, with an ASCII sign; never "-0.00".
/// \throws std::invalid_argument if it is not finite.
[[nodiscard]] std::string number_of(double value, const Column& column);
/// A row's cells, at most as many as the table has columns. \throws std::invalid_argument for more.
void check_row(const Table& table, const Row& row);

/// For text between tags and in quoted attributes; invalid UTF-8 becomes the replacement character,
/// since file names are bytes.
[[nodiscard]] std::string escaped(std::string_view bytes);

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

}  // namespace chaintrue::report
