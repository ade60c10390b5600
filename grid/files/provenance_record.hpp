// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The key "made_by" of maps, diagnoses and anchors. Like the hash of the content it belongs to the
/// file, not to its content. Private to grid/files.
#pragma once

#include <optional>

#include "grid/files/json_reader.hpp"
#include "grid/provenance.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] const Record<Provenance>& provenance_record();

/// The key, for a record whose files are completed by with_made_by.
template <class T>
Record<T>& add_made_by_key(Record<T>& record) {
  return record.custom(
      "made_by",
      "Provenance; absent if unknown.",
      false,
      provenance_record().expected(),
      [](const Cursor& at, T&) { (void)provenance_record().read(at); },
      [](const T&) { return std::optional<Json>(); });
}

/// The document with that key at its end, if known.
[[nodiscard]] Json with_made_by(Json document, const std::optional<Provenance>& made_by);

}  // namespace chaintrue::grid::files
