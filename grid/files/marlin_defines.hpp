// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The numbers that Marlin's Configuration.h defines, as its compiler sees them: names stand for what
/// they are defined as, and sums are evaluated. Private to grid/files.
///
///   #define X_BED_SIZE 1150
///   #define X_MIN_POS (-X_BED_SIZE/2)                  // -575
///   #define DEFAULT_AXIS_STEPS_PER_UNIT { 80, 80, 400 }
///
/// Conditions (#if) are not evaluated: of a name that is defined in two ways nothing is known.
///
/// \code
///   const SettingTexts texts = marlin_texts(text, {"X_MIN_POS", "DEFAULT_AXIS_STEPS_PER_UNIT"}, problems);
///   texts.at("X_MIN_POS").text;                        // "-575"
///   texts.at("DEFAULT_AXIS_STEPS_PER_UNIT/0").text;    // "80"
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/files/setting_reader.hpp"

namespace chaintrue::grid::files {

/// Of the names that are defined. What is no number is reported with its line.
[[nodiscard]] SettingTexts marlin_texts(const std::string& text,
                                        const std::vector<std::string>& names,
                                        Problems& problems);

}  // namespace chaintrue::grid::files
