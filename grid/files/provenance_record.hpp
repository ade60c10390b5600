// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The key "made_by" of maps, diagnoses and anchors. Like the hash of the content it belongs to the
/// file, not to its content. Private to grid/files.
#pragma once

#include <optional>
#include <string>

#include "grid/files/json_reader.hpp"
#include "grid/files/json_text.hpp"
#include "grid/provenance.hpp"

namespace chaintrue::grid::files {

Record<Provenance> provenance_record();

/// The key, for a record whose files are completed by with_made_by.
template <class T>
Record<T>& add_made_by_key(Record<T>& record) {
  return record.beside("made_by", "Provenance; absent if unknown.", false,
                       object(provenance_record()));
}

/// The document with that key at its end, if known.
[[nodiscard]] Json with_made_by(Json document, const std::optional<Provenance>& made_by);

// A hash that detects changes of a file since it was written. Private to grid/files.
//
// SHA-256 over the values as the writer would write them on one line: layout and comments do not count; every number, name and key does.
// It detects mistakes and damage, not tampering.

/// 64 hexadecimal digits. The root's "content_hash" and "comment" keys anywhere are left out.
std::string content_hash(const Json& document);

/// The text of the document with the hash of its content as its last key.
std::string print_with_hash(Json document);

/// Reports a hash that is not that of the file's content.
void check_content(const Cursor& at);

/// The key of the hash, for a record whose files are printed by print_with_hash and checked by
/// check_content. It belongs to the file, not to the object.
template <class T>
Record<T>& add_content_hash(Record<T>& record, std::string_view meaning) {
  Value<std::string> hash = text();
  hash.expected.words = "the hash of this file's content";
  return record.beside("content_hash", meaning, true, hash);
}

}  // namespace chaintrue::grid::files
