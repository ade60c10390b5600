// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Keys shared by several parts of a chaintrue_diagnosis file. Private to grid/files.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

/// The side of an effect, as in files.
[[nodiscard]] inline Value<std::string> side_word() {
  return one_of({"left", "right", "both", "x", "y", "tl", "tr", "bl", "br", "all"});
}

[[nodiscard]] Value<diagnosis::Verdict> verdict_word();

/// A text that is null in the file when empty.
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
