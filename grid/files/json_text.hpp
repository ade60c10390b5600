// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// JSON text to values and back. Private to grid/files: no other layer uses the JSON library.
///
/// Reading keeps the order of keys, reports every key that occurs twice, and turns numbers that are
/// not JSON (NaN, Infinity, 1e999) into texts, so that the field's own check reports them by their
/// pointer and reading continues. Writing prints each number in the fewest digits that read back as
/// the same double, keys in the order they were added, in a layout that depends on the values only.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

using Json = nlohmann::ordered_json;

/// Duplicate keys are added to `problems` by pointer. \throws InputError immediately, with line and
/// column, for text that is not JSON.
Json parse_json(const std::string& text, Problems& problems);

/// For a look at a text: keys that occur twice are ignored.
Json parse_json(const std::string& text, const std::string& file);
/// What stands before the first error, which is added to `problems`.
Json parse_head(const std::string& text, Problems& problems);

/// Two blanks per level, lines of at most 100 characters where the values allow, a line break at
/// the end. \throws std::logic_error where a number is not finite.
std::string print_json(const Json& value);

/// A value on one line, for messages.
std::string compact_json(const Json& value);

/// A list with what `each` makes of every element.
template <class Range, class Each>
Json json_list(const Range& range, const Each& each) {
  Json list = Json::array();
  for (const auto& element : range) list.push_back(each(element));
  return list;
}

/// The JSON pointer of the member or element `key` of the value at `parent`.
template <class Key>
std::string pointer_below(const std::string& parent, const Key& key) {
  return (Json::json_pointer(parent) / key).to_string();
}

}  // namespace chaintrue::grid::files
