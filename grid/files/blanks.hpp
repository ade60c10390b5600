// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Blanks around words in a line of text. Private to grid/files.
#pragma once

#include <string_view>

namespace chaintrue::grid::files {

[[nodiscard]] inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace chaintrue::grid::files
