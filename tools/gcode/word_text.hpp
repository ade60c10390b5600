// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Formats the value of a word.
#pragma once

#include <string>
#include <string_view>

namespace chaintrue::gcode {

/// The word and the shortest decimal fraction that reads back as the same number: no exponent,
/// which no controller reads, and no minus zero.
/// \code
///   with_value("G4 P", 1e-5)   // G4 P0.00001
/// \endcode
[[nodiscard]] std::string with_value(std::string_view word, double value);

}  // namespace chaintrue::gcode
