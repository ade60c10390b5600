// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/gcode/plotter_codes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "tools/gcode/block.hpp"

namespace chaintrue::gcode {
namespace {

/// M17, M18, M84: motors on and off. M42, M106, M107: a pin, or a fan's output, that a pen hangs on.
/// M201 to M205: speeds and accelerations. M280: a servo. M300: a sound. M400: wait until moves are done.
constexpr std::string_view kPassedCodes =
    " M17 M18 M42 M84 M106 M107 M201 M203 M204 M205 M280 M300 M400 ";

bool opens_word(char c) { return c >= 'a' && c <= 'z'; }

/// Digits with at most one point, and a sign before them.
bool is_plain_number(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  std::size_t end = past_digits(text, 0);
  if (text.substr(end).starts_with('.')) end = past_digits(text, end + 1);
  return end == text.size() && !text.empty() && text != ".";
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

/// -1 if the text has other characters than digits, or too many.
int number_of(std::string_view text) {
  constexpr int kLargest = 9999;
  int number = -1;
  const char* end = text.data() + text.size();
  const bool is_whole = std::from_chars(text.data(), end, number).ptr == end;
  return is_whole && number <= kLargest ? number : -1;
}

/// Not words with numbers, a comment or an expression.
bool is_prose(std::string_view text) {
  text = text.substr(0, text.find('('));
  return text.find_first_of("#[") == std::string_view::npos &&
         std::adjacent_find(text.begin(), text.end(), [](char a, char b) {
           return is_letter(a) && is_letter(b);
         }) != text.end();
}

}  // namespace

std::optional<PlotterWord> plotter_word(const CleanLine& line, std::size_t at, bool homes_itself) {
  std::string_view rest(line.text);
  rest.remove_prefix(std::min(at, rest.size()));
  std::optional<PlotterWord> word;
  bool homes = false;
  while (!rest.empty()) {
    if (!opens_word(rest.front())) return std::nullopt;
    const auto next = std::find_if(rest.begin() + 1, rest.end(), opens_word);
    const auto end = static_cast<std::size_t>(next - rest.begin());
    const std::string_view number = rest.substr(1, end - 1);
    const char letter = upper(rest.front());
    if (!word) {
      word = {{letter, 10 * number_of(number)}, {}};
      homes = word->code == g::home;
      if (!homes && letter != 'M') return std::nullopt;
      const std::string code = fmt::format(" {} ", name(word->code));
      if (!homes && kPassedCodes.find(code) == std::string_view::npos) return std::nullopt;
    } else {
      const bool is_axis = std::string_view("XYZ").find(letter) != std::string_view::npos;
      homes_itself = homes_itself || number.empty();
      if (homes ? !is_axis : !is_plain_number(number)) return std::nullopt;
      if (homes && !number.empty() && !is_plain_number(number)) return std::nullopt;
      word->words.append({' ', letter}).append(number);
    }
    rest.remove_prefix(end);
  }
  return homes && !homes_itself ? std::nullopt : word;
}

std::optional<TextLine> text_line(std::string_view raw, bool of_plotter) {
  raw = trimmed(raw);
  if (raw.empty() || (raw.front() != 'M' && raw.front() != 'm')) return std::nullopt;
  const std::size_t end = past_digits(raw, 1);
  const int number = number_of(raw.substr(1, end - 1));
  const bool shows = of_plotter && (number == 117 || number == 118);
  if (!shows && number != 0 && number != 1) return std::nullopt;
  const std::size_t semicolon = std::min(raw.find(';'), raw.size());
  const std::string_view text = trimmed(raw.substr(end, semicolon - end));
  if (!shows && !is_prose(text)) return std::nullopt;
  TextLine line{m(number), std::string(text), {}};
  if (semicolon < raw.size())
    line.comments.push_back({std::string(raw.substr(semicolon + 1)), true});
  return line;
}

}  // namespace chaintrue::gcode
