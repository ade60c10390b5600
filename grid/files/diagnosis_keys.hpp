// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Keys that several parts of a chaintrue_diagnosis file have. Private to grid/files.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

/// A side on which an effect acts, as files have it.
[[nodiscard]] inline Value<std::string> side_word() {
  return one_of({"left", "right", "both", "x", "y", "tl", "tr", "bl", "br", "all"});
}

[[nodiscard]] Value<diagnosis::Verdict> verdict_word();

/// An empty text is null in the file.
template <class T>
void nullable_text(Record<T>& record,
                   const std::string& key,
                   std::string T::*member,
                   const Value<std::string>& value) {
  record.custom(
      key,
      false,
      value.expected,
      [member, value](const Cursor& at, T& object) {
        if (auto word = value.read(at)) object.*member = std::move(*word);
      },
      [member](const T& object) {
        return std::optional<Json>((object.*member).empty() ? Json(nullptr) : Json(object.*member));
      });
}

}  // namespace chaintrue::grid::files
