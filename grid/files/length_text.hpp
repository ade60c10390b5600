// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lengths as people write them into a table or behind an option: with a unit, or as the fraction
/// that an inch rule shows. Private to grid/files.
///
///   text                     mm
///   12.5 mm, 1.25 cm, 2 m    12.5, 12.5, 2000
///   43 in, 43", 43 inches    1092.2
///   43 13/16, -43 13/16"     1112.8375, -1112.8375: a fraction is one of an inch
///   5/8                      15.875
///   3' 8 5/16", 3 ft         1125.5375, 914.4
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace chaintrue::grid::files {

/// Millimetres; empty if the text is neither a length with a unit nor a fraction. A bare number is
/// neither: its unit is that of its place. \post The value is finite.
[[nodiscard]] std::optional<double> length_with_unit_mm(std::string_view text);

/// The fraction that a spreadsheet turned into a date: `Jan-32` was 1/32, `16-Mar` 3/16. Empty if
/// the text is not such a date.
[[nodiscard]] std::optional<std::string> fraction_of_date(std::string_view text);

}  // namespace chaintrue::grid::files
