// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/gcode/plotter_codes.hpp"

#include <algorithm>
#include <string_view>

namespace chaintrue::gcode {
namespace {

/// M17, M18, M84: motors on and off. M42, M106, M107: a pin, or a fan's output, that a pen hangs on.
/// M201 to M205: speeds and accelerations. M280: a servo. M400: wait until moves are done.
constexpr std::string_view kCodes[] = {
    "17", "18", "42", "84", "106", "107", "201", "203", "204", "205", "280", "400"};

bool is_decimal(char c) { return c >= '0' && c <= '9'; }
bool opens_word(char c) { return c >= 'a' && c <= 'z'; }

/// Digits with at most one point, and a sign before them.
bool is_plain_number(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return std::any_of(text.begin(), text.end(), is_decimal) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_decimal(c) || c == '.'; }) &&
         std::count(text.begin(), text.end(), '.') <= 1;
}

}  // namespace

std::optional<std::string> plotter_word(const CleanLine& line, std::size_t at) {
  std::string_view rest(line.text);
  rest.remove_prefix(std::min(at, rest.size()));
  std::string words;
  while (!rest.empty()) {
    if (!opens_word(rest.front())) return std::nullopt;
    const std::size_t end = std::min(
        static_cast<std::size_t>(std::find_if(rest.begin() + 1, rest.end(), opens_word) - rest.begin()),
        rest.size());
    std::string_view number = rest.substr(1, end - 1);
    const bool is_code = words.empty();
    if (is_code) {
      while (number.size() > 1 && number.front() == '0') number.remove_prefix(1);
      const bool is_known = std::find(std::begin(kCodes), std::end(kCodes), number) != std::end(kCodes);
      if (rest.front() != 'm' || !is_known) return std::nullopt;
    } else if (!is_plain_number(number)) {
      return std::nullopt;
    } else {
      words += ' ';
    }
    words += static_cast<char>(rest.front() - 'a' + 'A');
    words += number;
    rest.remove_prefix(end);
  }
  return words.empty() ? std::nullopt : std::optional(words);
}

}  // namespace chaintrue::gcode
