// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/length_text.hpp"
#include "grid/files/parse_double.hpp"

namespace chaintrue::grid::files {
namespace {

/// parse_double accepts no plus sign.
std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

struct Parsed {
  double value = 0.0;
  bool is_whole = false;
  bool is_out_of_range = false;
};

Parsed parse(std::string_view text) {
  text = without_plus(text);
  Parsed parsed;
  const auto [end, error] = parse_double(text.data(), text.data() + text.size(), parsed.value);
  parsed.is_whole = !text.empty() && end == text.data() + text.size();
  parsed.is_out_of_range = error == std::errc::result_out_of_range;
  return parsed;
}

/// Among the texts outside a double's range, those with a negative exponent are near zero; so are
/// those without an exponent, 0.000...
bool is_near_zero(std::string_view text) {
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent != std::string_view::npos && exponent + 1 < text.size())
    return text[exponent + 1] == '-';
  const std::size_t first = text.find_first_not_of("+-");
  return first != std::string_view::npos && (text[first] == '0' || text[first] == '.');
}

}  // namespace

std::string Range::expected() const {
  const std::string in_unit = unit.empty() ? std::string() : fmt::format(" in {}", unit);
  return fmt::format("a number{} from {} to {}", in_unit, least, most);
}

std::optional<double> number_of(std::string_view text) {
  const Parsed parsed = parse(text);
  if (!parsed.is_whole) return std::nullopt;
  if (parsed.is_out_of_range) return is_near_zero(text) ? std::optional(0.0) : std::nullopt;
  return std::isfinite(parsed.value) ? std::optional(parsed.value) : std::nullopt;
}

std::vector<std::string> parts_at_commas(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    parts.emplace_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  return parts;
}

std::optional<std::array<int, 2>> pair_of(std::string_view text,
                                          char between,
                                          int least,
                                          int most) {
  std::array<int, 2> pair{};
  const char* const end = text.data() + text.size();
  const auto [middle, first] = std::from_chars(text.data(), end, pair[0]);
  if (first != std::errc{} || middle == end || *middle != between) return std::nullopt;
  const auto [last, second] = std::from_chars(middle + 1, end, pair[1]);
  const bool holds = std::min(pair[0], pair[1]) >= least && std::max(pair[0], pair[1]) <= most;
  return second == std::errc{} && last == end && holds ? std::optional(pair) : std::nullopt;
}

bool is_beyond_double(std::string_view text) {
  const Parsed parsed = parse(text);
  if (!parsed.is_whole) return false;
  return parsed.is_out_of_range ? !is_near_zero(text) : !std::isfinite(parsed.value);
}

bool looks_like_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.find(',', comma + 1) != std::string_view::npos) {
    return false;
  }
  if (comma == 0 || comma + 1 == text.size()) return false;
  if (!is_digit(text[comma - 1]) || !is_digit(text[comma + 1])) return false;
  return all_of(text, [](char c) {
    return is_digit(c) || c == ',' || c == '.' || c == '-' || c == '+' || c == ' ';
  });
}

ProblemKind kind_of_bad_number(std::string_view text) {
  if (looks_like_decimal_comma(text)) return ProblemKind::decimal_comma;
  return number_of(text) ? ProblemKind::out_of_range : ProblemKind::not_a_number;
}

std::optional<double> checked_number(std::string_view text,
                                     const std::string& place,
                                     std::string_view name,
                                     const Range& range,
                                     Problems& problems) {
  auto value = number_of(text);
  if (!value && range.unit == "mm") value = length_with_unit_mm(text);
  if (value && range.holds(*value)) return value;
  std::string hint = looks_like_decimal_comma(text) ? ", with a decimal point, not a comma" : "";
  if (const auto fraction = fraction_of_date(text)) {
    hint = fmt::format(
        "; a spreadsheet converted {0} to a date: write 0 {0}, in a column formatted as text",
        *fraction);
  }
  problems.add(place,
               text,
               fmt::format("{} ({}){}", range.expected(), name, hint),
               kind_of_bad_number(text));
  return std::nullopt;
}

}  // namespace chaintrue::grid::files
