// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// JSON text to values and back. Private to grid/files: no other room sees the JSON library.
///
/// Reading keeps the order of keys, names every key that stands twice, and turns what a program in
/// a hurry writes for a number (NaN, Infinity, 1e999) into a text, so that the field's own check
/// reports it by its pointer and reading goes on. Writing gives each number in the fewest digits
/// that read back as the same double, keys in the order they were added, and a layout that depends
/// on the values only.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

using Json = nlohmann::ordered_json;

/// Duplicate keys are added to `problems` by pointer.
/// \throws InputError at once, with line and column, for text that is not JSON.
[[nodiscard]] Json parse_json(const std::string& text, Problems& problems);

/// Two blanks a level, lines of at most 100 characters where the values allow, a line break at the
/// end. \throws std::logic_error where a number is not finite: such a value must not reach a
/// writer.
[[nodiscard]] std::string print_json(const Json& value);

/// A value on one line, as messages show it.
[[nodiscard]] std::string compact_json(const Json& value);

/// `key` as one token of a JSON pointer.
[[nodiscard]] std::string pointer_token(std::string_view key);

}  // namespace chaintrue::grid::files
