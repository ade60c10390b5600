// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Regular expressions (ECMAScript) for the forms in which people and machines write. Private to
/// grid/files.
///
/// \code
///   const auto part = match("43 13/16", "([0-9]+) ([0-9]+)/([0-9]+)");
///   part[0];   // "43 13/16"
///   part[3];   // "16"; a group that takes no part is empty
/// \endcode
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::grid::files {

/// The text and the pattern's groups in it; empty if the text as a whole is not of this form.
/// `pattern` lives as long as the program.
std::vector<std::string_view> match(std::string_view text, const char* pattern);

/// The text with everything in it that is of this form replaced, "$1" by its first group. Repetitions
/// in such a pattern have an upper bound.
std::string replaced(const std::string& text, const char* pattern, const char* with);

}  // namespace chaintrue::grid::files
