// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers as users and programs write them into files and on the command line, read independent of
/// the locale.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

/// Range of a number; `unit` may be empty. Both ends are allowed.
struct Range {
  std::string_view unit;
  double least = 0.0;
  double most = 0.0;
  bool holds(double value) const { return value >= least && value <= most; }
  std::string expected() const;
};

/// The finite number that the whole text denotes. A leading plus sign is allowed; a number nearer
/// to zero than the smallest double is zero; numbers beyond the largest, NaN and infinity are
/// rejected.
std::optional<double> number_of(std::string_view text);

/// A whole number in this range; empty for any other text.
std::optional<int> whole_number_of(std::string_view text, int least, int most);

/// "7x4" for 'x': two whole numbers from `least` to `most`; empty for any other text.
std::optional<std::array<int, 2>> pair_of(std::string_view text, char between, int least, int most);

/// True for a number outside a double's range: 1e999, NaN, Infinity.
bool is_beyond_double(std::string_view text);

/// The parts of an option's text between its commas, each read by `one`, which returns nothing for a wrong part.
/// \throws InputError
template <class One>
auto list_of_option(const std::string& text, const std::string& option, const std::string& expected,
                    One one) {
  std::vector<typename decltype(one(text))::value_type> list;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const auto read = one(text.substr(begin, comma - begin));
    begin = comma + 1;
    if (!read) refuse("the command line", option, shortened(text), expected);
    list.push_back(*read);
  }
  return list;
}

/// True for `12,5` and `-1.200,5`: a number written with a decimal comma.
bool looks_like_decimal_comma(std::string_view text);
/// For a text in place of a number within a range.
ProblemKind kind_of_bad_number(std::string_view text);

/// The number in its range; otherwise reports it at `place` and returns nothing. `name` is the name
/// of the value in the message.
std::optional<double> checked_number(std::string_view text, const std::string& place,
                                     std::string_view name, const Range& range, Problems& problems);

// Lengths as people write them into a table or behind an option: with a unit, or as the fraction
// that an inch rule shows. Private to grid/files.
//
//   text                     mm
//   12.5 mm, 1.25 cm, 2 m    12.5, 12.5, 2000
//   43 in, 43", 43 inches    1092.2
//   43 13/16, -43 13/16"     1112.8375, -1112.8375: a fraction is one of an inch
//   5/8                      15.875
//   3' 8 5/16", 3 ft         1125.5375, 914.4

/// Millimetres; empty if the text is neither a length with a unit nor a fraction. A bare number is
/// neither: its unit is that of its place. \post The value is finite.
std::optional<double> length_with_unit_mm(std::string_view text);

/// The fraction that a spreadsheet turned into a date: `Jan-32` was 1/32, `16-Mar` 3/16. Empty if
/// the text is not such a date.
std::optional<std::string> fraction_of_date(std::string_view text);

}  // namespace chaintrue::grid::files
