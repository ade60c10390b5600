// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Letters and blanks in a line of text, and what may stand before a text. Private to grid/files.
#pragma once

#include <string>
#include <string_view>

namespace chaintrue::grid::files {

/// The position that a search returns if the text does not contain the word.
inline constexpr std::size_t npos = std::string_view::npos;

/// Whether the text contains this letter or word.
template <class Word>
bool has(std::string_view text, const Word& word) {
  return text.find(word) != npos;
}

/// The text up to the next mark; the rest begins after it.
inline std::string_view take_until(std::string_view& rest, char mark) {
  const std::size_t end = rest.find(mark);
  const std::string_view taken = rest.substr(0, end);
  rest = end == npos ? std::string_view{} : rest.substr(end + 1);
  return taken;
}

constexpr char in_lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

inline std::string in_small_letters(std::string_view text) {
  std::string small;
  for (const char c : text) small += in_lower_case(c);
  return small;
}
constexpr bool is_letter(char c) { return in_lower_case(c) >= 'a' && in_lower_case(c) <= 'z'; }

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Some programs write a second byte order mark.
[[nodiscard]] inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  while (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

}  // namespace chaintrue::grid::files
