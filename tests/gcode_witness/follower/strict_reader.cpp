// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/follower/strict_reader.hpp"

#include <cmath>
#include <set>

namespace chaintrue::follower {
namespace {

constexpr std::size_t kLongestLine = 80;
/// grbl keeps this number of significant digits and drops the rest (MAX_INT_DIGITS).
constexpr int kDigits = 8;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::optional<double> strict_number(const std::string& text) {
  std::size_t at = 0;
  const bool negative = at < text.size() && text[at] == '-';
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
  double value = 0.0;
  int digits = 0;
  int exponent = 0;
  bool point = false;
  bool any = false;
  for (; at < text.size(); ++at) {
    if (text[at] == '.' && !point) {
      point = true;
      continue;
    }
    if (!is_digit(text[at])) return std::nullopt;
    any = true;
    if (digits < kDigits) {
      value = 10.0 * value + (text[at] - '0');
      digits += value == 0.0 ? 0 : 1;
      exponent -= point ? 1 : 0;
    } else {
      exponent += point ? 0 : 1;
    }
  }
  if (!any) return std::nullopt;
  value *= std::pow(10.0, exponent);
  return negative ? -value : value;
}

std::optional<StrictLine> read_strictly(const std::string& line, std::string& objection) {
  if (line.size() > kLongestLine) {
    objection = "the line is longer than 80 characters";
    return std::nullopt;
  }
  StrictLine result;
  std::set<char> found;
  for (std::size_t at = 0; at < line.size();) {
    const char letter = line[at];
    if (letter == ' ') {
      ++at;
      continue;
    }
    if (letter == '(') {
      const std::size_t end = line.find_first_of("()", at + 1);
      if (end == std::string::npos || line[end] == '(') {
        objection = "a comment is nested or not closed";
        return std::nullopt;
      }
      at = end + 1;
      continue;
    }
    if (letter < 'A' || letter > 'Z') {
      objection = std::string("a word cannot begin with ") + letter;
      return std::nullopt;
    }
    std::size_t end = at + 1;
    while (end < line.size() &&
           (is_digit(line[end]) || line[end] == '.' || line[end] == '-' || line[end] == '+'))
      ++end;
    const auto value = strict_number(line.substr(at + 1, end - at - 1));
    if (!value) {
      objection = "no number follows the letter " + line.substr(at, end - at);
      return std::nullopt;
    }
    if (letter != 'G' && letter != 'M' && !found.insert(letter).second) {
      objection = std::string("a second word ") + letter;
      return std::nullopt;
    }
    result.words.emplace_back(letter, *value);
    at = end;
  }
  return result;
}

}  // namespace chaintrue::follower
