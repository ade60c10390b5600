// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/files/maslow4_scan.hpp"
#include "grid/files/maslow4_text.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/ranges.hpp"

namespace chaintrue::grid::files {
namespace {

/// The reading that this text is; empty for objects of other programs.
std::optional<ScannedReading> read(std::string text, std::size_t line, std::size_t column,
                                   bool is_closed, const std::string& file) {
  std::erase(text, '\n');
  Problems problems(file);
  const std::string place = line_and_column(line, column);
  PerBelt<double> lengths_mm;
  PerBelt<bool> known;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view part = take_until(rest, ',');
    std::string_view length = part;
    const auto belt = model::belt_of(unquoted(take_until(length, ':')));
    if (!belt || !has(part, ':')) continue;
    if (known[*belt]) {
      problems.add(place, std::string(unquoted(part)), ProblemKind::repeated_value,
                   "each belt once in a reading");
      continue;
    }
    known[*belt] = true;
    const auto value = checked_number(unquoted(length), place, name(*belt), kLengthMm, problems);
    if (value) lengths_mm[*belt] = *value;
  }
  if (none_of(kBelts, [&](Belt belt) { return known[belt]; })) return std::nullopt;
  const std::string whole = fmt::format("{{{}{}", unquoted(text), is_closed ? "}" : "");
  for (const Belt belt : kBelts) {
    if (!known[belt]) {
      problems.add(place, whole, ProblemKind::missing,
                   "a length of {} too; a reading has tl, tr, bl and br", name(belt));
    }
  }
  if (!is_closed && !problems.any())
    problems.add(place, whole, ProblemKind::missing,
                 "a complete reading; the log ends in the middle of this one");
  ScannedReading reading;
  reading.line = line;
  reading.problems = problems.list();
  if (!problems.any()) reading.lengths_mm = lengths_mm;
  return reading;
}

}  // namespace

FoundReadings readings_in(const LogLine& line, const std::string& file) {
  FoundReadings found;
  const std::string_view text = line.text;
  std::size_t sign = npos;  // the last one
  bool is_open = false;
  const auto take = [&](std::size_t end, bool is_closed) {
    auto reading = read(std::string(text.substr(sign + 1, end - sign - 1)),
                        line.number + count_equal(text.substr(0, sign + 1), '\n'),
                        is_open ? sign - text.rfind('\n', sign) : 1, is_closed, file);
    if (reading) found.readings.push_back(*std::move(reading));
  };
  for (const auto at : each_index(text)) {
    const char c = text[at];
    if (c != '{' && c != '}' && c != ']' && (c != '\n' || is_open)) continue;
    // A number that another sign ends is whole, though the bracket is lost.
    if (is_open || c == '}') take(at, true);
    found.list_ends = found.list_ends || c == ']';
    is_open = c == '{';
    sign = at;
  }
  if (is_open) take(text.size(), false);
  return found;
}

}  // namespace chaintrue::grid::files
