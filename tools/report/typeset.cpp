// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/typeset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/precondition.hpp"

namespace chaintrue::report {
namespace {

/// Number of bytes of the UTF-8 character at the text's beginning; 0 if it is not valid (RFC 3629).
std::size_t character_length(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned second = byte(1);
  const bool is_overlong = (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
  const bool is_no_character =
      (first == 0xEDU && second > 0x9FU) || (first == 0xF4U && second > 0x8FU);
  return is_overlong || is_no_character ? 0 : length;
}

/// File names are bytes: invalid UTF-8 becomes the replacement character.
std::string as_utf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    out += length == 0 ? std::string_view("\xEF\xBF\xBD") : text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

}  // namespace

std::string escaped(std::string_view bytes) {
  const std::string text = as_utf8(bytes);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string typeset(std::string text) {
  constexpr std::string_view kTyped = " +- ", kSet = "\u00a0\u00b1\u00a0", kAtFirst = "+- ";
  if (text.starts_with(kAtFirst)) text.replace(0, kAtFirst.size(), "\u00b1\u00a0");
  for (std::size_t at = text.find(kTyped); at != std::string::npos; at = text.find(kTyped, at))
    text.replace(at, kTyped.size(), kSet);
  return text;
}

std::string number_of(double value, const Column& column) {
  if (!std::isfinite(value)) throw grid::precondition("{} is {}", column.heading, value);
  std::string text = column.has_sign ? fmt::format("{:+.{}f}", value, column.digits)
                                     : fmt::format("{:.{}f}", value, column.digits);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos)
    text.replace(0, 1, column.has_sign ? "+" : "");
  return text;
}

std::string fixed(double value, int digits) {
  const std::string text = number_of(value, {.heading = "a number", .digits = digits});
  return text.front() == '-' ? "\u2212" + text.substr(1) : text;
}

void check_row(const Table& table, const Row& row) {
  if (row.cells.size() <= table.columns.size()) return;
  throw grid::precondition(
      "a table row has {} cells for {} columns", row.cells.size(), table.columns.size());
}

}  // namespace chaintrue::report
