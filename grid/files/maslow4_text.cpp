// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_text.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/pattern.hpp"

namespace chaintrue::grid::files {
namespace {

/// Without control characters, and colour codes: "\x1b[0;32m", or "[0;32m" where a clipboard lost the
/// first character.
std::string cleaned(std::string_view line) {
  std::string text =
      replaced(std::string(line), "\x1b(?:\\[[0-9;]{0,30}(?:[A-Za-z]|$))?|\\[[0-9;]{1,30}m", "");
  std::replace(text.begin(), text.end(), '\t', ' ');
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == '\x7f'; });
  return text;
}

/// A message without readings that its line does not end. The list of waypoints is the longest.
bool is_message_without_end(std::string_view line) {
  constexpr std::size_t kLongestMessage = 8000;
  return line.starts_with("[MSG") && !has(line, '{') && !has(line, "CLBM") &&
         line.size() < kLongestMessage && count_equal(line, '[') > count_equal(line, ']');
}

}  // namespace

std::string_view unquoted(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\"'";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

bool is_other_output(std::string_view line) {
  const std::string_view text = unquoted(line);
  if (text.empty()) return true;
  if (text.front() == '<' || text.front() == '$' || text == "ok" || text.starts_with("error:") ||
      text.starts_with("ALARM"))
    return true;
  // "[MSG:INFO: ...]", "[G92:0,0]", "[ESP400]", but not "[{bl:.."
  return text.size() > 1 && text.front() == '[' && is_letter(text[1]) && text[1] <= 'Z' &&
         !has(text, '{');
}

bool is_heading(std::string_view line) {
  return !match(line,
                "[/# \t]*[Rr][Uu][Nn] [ \t\r\"']*"
                "[^ \t\r\"'](?:[^ ]{0,10}[^ \t\r\"'])?[ \t\r\"']*")
              .empty();
}

std::vector<LogLine> log_lines(const std::string& text) {
  std::vector<LogLine> lines;
  std::size_t number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    std::string line = cleaned(take_until(rest, '\n'));
    ++number;
    const bool goes_on = !lines.empty() && !line.empty() && lines.back().number + 1 == number &&
                         is_message_without_end(lines.back().text) && !is_other_output(line) &&
                         !is_heading(line) && !has(line, '{') && !has(line, "CLBM");
    if (goes_on) {
      lines.back().text += line;
    } else {
      lines.push_back({std::move(line), number});
    }
  }
  return lines;
}

std::optional<double> number_after(std::string_view line, std::string_view word) {
  const std::size_t at = line.find(word);
  if (at == npos) return std::nullopt;
  std::size_t from = at + word.size();
  while (from < line.size() && line[from] == ' ') ++from;
  const std::size_t end = line.find_first_not_of("+-.0123456789eE", from);
  return number_of(line.substr(from, end == npos ? end : end - from));
}

std::optional<int> waypoint_of(std::optional<double> number) {
  constexpr double kMost = 1e6;  // the firmware's are a few hundred
  if (!number || !(*number >= 0.0) || !(*number <= kMost) || *number != std::floor(*number))
    return std::nullopt;
  return static_cast<int>(*number);
}

}  // namespace chaintrue::grid::files
