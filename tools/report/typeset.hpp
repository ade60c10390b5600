// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers and texts as a document's renderers set them.
#pragma once

#include <string>
#include <string_view>

#include "tools/report/document.hpp"

namespace chaintrue::report {

[[nodiscard]] std::string capitalised(std::string text);
/// For a page: +- as one sign that no line is broken at.
[[nodiscard]] std::string typeset(std::string text);
/// Fixed digits with a true minus sign, never "-0.00".
[[nodiscard]] std::string fixed(double value, int digits);
/// The number of a column, with an ASCII sign; never "-0.00".
/// \throws std::invalid_argument where it is not finite.
[[nodiscard]] std::string number_of(double value, const Column& column);
/// A row's cells, which are as many as the table has columns at most.
/// \throws std::invalid_argument where they are more.
void check_row(const Table& table, const Row& row);

/// For text between tags and in quoted attributes; bytes that are no UTF-8 become the replacement
/// character, since file names are bytes.
[[nodiscard]] std::string escaped(std::string_view bytes);

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

}  // namespace chaintrue::report
