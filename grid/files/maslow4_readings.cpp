// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/files/maslow4_scan.hpp"
#include "grid/files/maslow4_text.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/ranges.hpp"

namespace chaintrue::grid::files {
namespace {

/// A reading has some 60 characters; a terminal breaks it over two lines, seldom three.
constexpr std::size_t kLongestReading = 200;
constexpr std::size_t kMostLines = 3;

}  // namespace

void ReadingReader::begin(std::size_t number, std::size_t column) {
  open_ = true;
  text_.clear();
  outside_.clear();
  line_ = number;
  column_ = column;
  lines_ = 1;
}

ReadingReader::Found ReadingReader::take(std::string_view line, std::size_t number) {
  Found found;
  const auto add = [&found](std::optional<ScannedReading> reading) {
    if (reading) found.readings.push_back(*std::move(reading));
  };
  outside_.clear();
  if (open_) ++lines_;
  for (const auto at : each_index(line)) {
    const char c = line[at];
    if (open_ && (c == '}' || c == '{' || c == ']')) {
      open_ = false;
      // A number that another sign ends is whole, though the bracket is lost.
      add(read(text_));
      found.list_ends = found.list_ends || c == ']';
      if (c == '{') begin(number, at + 1);
    } else if (open_) {
      text_ += c;
    } else if (c == '{') {
      begin(number, at + 1);
    } else if (c == '}') {
      line_ = number;
      column_ = 1;
      add(read(outside_));
      outside_.clear();
    } else if (c == ']') {
      found.list_ends = true;
    } else {
      outside_ += c;
    }
  }
  if (open_ && (text_.size() > kLongestReading || lines_ > kMostLines)) add(give_up());
  return found;
}

std::optional<ScannedReading> ReadingReader::give_up() {
  if (!open_) return std::nullopt;
  open_ = false;
  return read(text_, false);
}

std::optional<ScannedReading> ReadingReader::read(const std::string& text, bool is_closed) const {
  Problems problems(file_);
  const std::string place = line_and_column(line_, column_);
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
  // Objects of other programs.
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
  reading.line = line_;
  reading.problems = problems.list();
  if (!problems.any()) reading.lengths_mm = lengths_mm;
  return reading;
}

}  // namespace chaintrue::grid::files
