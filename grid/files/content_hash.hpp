// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A hash that detects changes of a file since it was written. Private to grid/files.
///
/// SHA-256 over the values as the writer would write them on one line: layout and comments do not count; every number, name and key does.
/// It detects mistakes and damage, not tampering.
#pragma once

#include <string>

#include "grid/files/json_reader.hpp"
#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {

/// 64 hexadecimal digits. The root's "content_hash" and "comment" keys anywhere are left out.
[[nodiscard]] std::string content_hash(const Json& document);

/// The text of the document with the hash of its content as its last key.
[[nodiscard]] std::string print_with_hash(Json document);

/// Reports a hash that is not that of the file's content.
void check_content(const Cursor& at);

/// The key of the hash, for a record whose files are printed by print_with_hash and checked by
/// check_content. It belongs to the file, not to the object.
template <class T>
Record<T>& add_content_hash(Record<T>& record, std::string_view meaning) {
  return record.custom(
      "content_hash",
      meaning,
      true,
      {"the hash of this file's content", text().expected.schema},
      [](const Cursor& at, T&) { (void)at.text(); },
      [](const T&) { return std::optional<Json>(); });
}

}  // namespace chaintrue::grid::files
