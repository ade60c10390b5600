// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The numbers that Marlin's Configuration.h defines, as its compiler sees them: without comments, names
/// replaced by what they are defined as, sums evaluated. Private to grid/files.
///
///   #define POLARGRAPH
///   #define X_BED_SIZE 1150
///   #define X_MIN_POS (-X_BED_SIZE/2)                  // -575
///   #define DEFAULT_AXIS_STEPS_PER_UNIT { 80, 80, 400 }
///   #if ENABLED(POLARGRAPH)                            // also DISABLED, ANY, ALL, NONE, defined
///     #define POLARGRAPH_MAX_BELT_LEN sqrt(sq(800.0) + sq(600.0))
///   #endif
///
/// Any other condition may hold or not: a name that is then defined in two ways is unknown. A
/// definition whose #if does not hold counts if there is no other.
///
/// \code
///   const SettingTexts texts = marlin_texts(text, {"X_MIN_POS", "DEFAULT_AXIS_STEPS_PER_UNIT"}, problems);
///   texts.at("X_MIN_POS").text;                        // "-575"
///   texts.at("DEFAULT_AXIS_STEPS_PER_UNIT/0").text;    // "80"
/// \endcode
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/files/setting_reader.hpp"

namespace chaintrue::grid::files {

/// The names that are defined. Values that are not numbers are reported with their lines.
SettingTexts marlin_texts(const std::string& text, const std::vector<std::string>& names,
                          Problems& problems);

/// The lines without comments.
[[nodiscard]] std::string without_comments(std::string_view text);

}  // namespace chaintrue::grid::files
