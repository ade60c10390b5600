// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_text.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/parse_double.hpp"

namespace chaintrue::grid::files {
namespace {

/// The length of a colour code at `at` ("\x1b[0;32m", or "[0;32m" where a clipboard lost the first
/// character); 0 if there is none.
std::size_t colour_code(std::string_view text, std::size_t at) {
  const bool has_escape = text[at] == '\x1b';
  std::size_t next = at + (has_escape ? 1 : 0);
  if (next >= text.size() || text[next] != '[') return has_escape ? 1 : 0;
  const std::size_t first = ++next;
  while (next < text.size() && (is_digit(text[next]) || text[next] == ';')) ++next;
  if (next >= text.size()) return has_escape ? next - at : 0;
  const bool is_code = has_escape ? is_letter(text[next]) : text[next] == 'm' && next > first;
  return is_code ? next + 1 - at : has_escape ? 1 : 0;
}

std::string cleaned(std::string_view line) {
  std::string text;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == '\x1b' || line[at] == '[') {
      if (const std::size_t length = colour_code(line, at)) {
        at += length;
        continue;
      }
    }
    const char c = line[at++];
    if (c == '\t') text += ' ';
    if (static_cast<unsigned char>(c) >= 0x20U && c != '\x7f') text += c;
  }
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
  std::string word;
  std::size_t at = line.find_first_not_of("/# \t");
  for (; at < line.size() && is_letter(line[at]); ++at) {
    word += in_lower_case(line[at]);
  }
  if (word != "run" || at >= line.size() || line[at] != ' ') return false;
  const std::string_view rest = unquoted(line.substr(at));
  constexpr std::size_t kLongestName = 12;
  return !rest.empty() && !has(rest, ' ') && rest.size() <= kLongestName;
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
