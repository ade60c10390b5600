// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/parse_double.hpp"
#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::files {

namespace {

/// Among the texts outside a double's range, those with a negative exponent are near zero; so are
/// those without an exponent, 0.000...
bool is_near_zero(std::string_view text) {
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent != npos && exponent + 1 < text.size()) return text[exponent + 1] == '-';
  const std::size_t first = text.find_first_not_of("+-");
  return first != npos && (text[first] == '0' || text[first] == '.');
}

/// Infinite beyond a double's range; empty for a text that is not a number as a whole.
std::optional<double> any_number(std::string_view text) {
  // parse_double accepts no plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = parse_double(text.data(), text.data() + text.size(), value);
  if (text.empty() || end != text.data() + text.size()) return std::nullopt;
  const bool is_beyond = error == std::errc::result_out_of_range && !is_near_zero(text);
  return is_beyond ? std::numeric_limits<double>::infinity() : value;
}

}  // namespace

std::string Range::expected() const {
  const std::string in_unit = unit.empty() ? std::string() : fmt::format(" in {}", unit);
  return fmt::format("a number{} from {} to {}", in_unit, least, most);
}

std::optional<double> number_of(std::string_view text) {
  const auto number = any_number(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

bool is_beyond_double(std::string_view text) {
  const auto number = any_number(text);
  return number && !std::isfinite(*number);
}

std::optional<int> whole_number_of(std::string_view text, int least, int most) {
  const auto number = number_of(text);
  const bool is_whole =
      number && *number >= least && *number <= most && *number == std::floor(*number);
  return is_whole ? std::optional(static_cast<int>(*number)) : std::nullopt;
}

std::optional<std::array<int, 2>> pair_of(std::string_view text, char between, int least,
                                          int most) {
  std::array<int, 2> pair{};
  const char* const end = text.data() + text.size();
  const auto [middle, first] = std::from_chars(text.data(), end, pair[0]);
  if (first != std::errc{} || middle == end || *middle != between) return std::nullopt;
  const auto [last, second] = std::from_chars(middle + 1, end, pair[1]);
  const bool holds = std::min(pair[0], pair[1]) >= least && std::max(pair[0], pair[1]) <= most;
  return second == std::errc{} && last == end && holds ? std::optional(pair) : std::nullopt;
}

bool looks_like_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == npos || text.find(',', comma + 1) != npos) {
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

std::optional<double> checked_number(std::string_view text, const std::string& place,
                                     std::string_view name, const Range& range,
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
  problems.add(place, text, kind_of_bad_number(text), "{} ({}){}", range.expected(), name, hint);
  return std::nullopt;
}

namespace {

using input_checks::kMmPerInch;
constexpr double kInchesPerFoot = 12.0;
/// The minus sign of spreadsheets and word processors.
constexpr std::string_view kLongMinus = "\xE2\x88\x92";
constexpr std::string_view kDoublePrime = "\xE2\x80\xB3";

struct Unit {
  std::string_view word;
  double mm;
};
/// Longer words first if one ends in another.
constexpr Unit kUnits[] = {{"mm", 1.0},
                           {"cm", 10.0},
                           {"m", 1000.0},
                           {"inches", kMmPerInch},
                           {"inch", kMmPerInch},
                           {"in", kMmPerInch},
                           {"\"", kMmPerInch},
                           {"''", kMmPerInch},
                           {kDoublePrime, kMmPerInch}};

/// Removes the unit from the text's end.
std::optional<double> take_unit(std::string_view& text) {
  for (const Unit& unit : kUnits) {
    if (!text.ends_with(unit.word)) continue;
    text = trimmed(text.substr(0, text.size() - unit.word.size()));
    return unit.mm;
  }
  return std::nullopt;
}

/// Digits alone: no sign, point or exponent.
std::optional<double> whole(std::string_view text) {
  const bool is_whole = !text.empty() && all_of(text, is_digit);
  return is_whole ? number_of(text) : std::nullopt;
}

/// `13/16` or `43 13/16`, without a sign.
std::optional<double> fraction(std::string_view text) {
  double before = 0.0;
  if (const std::size_t gap = text.find_first_of(" -"); gap != npos) {
    const auto inches = whole(text.substr(0, gap));
    if (!inches) return std::nullopt;
    before = *inches;
    text = trimmed(text.substr(gap + 1));
  }
  const std::size_t slash = text.find('/');
  if (slash == npos) return std::nullopt;
  const auto above = whole(text.substr(0, slash));
  const auto below = whole(text.substr(slash + 1));
  // 13/8 of an inch, or a date, is not a reading of a rule.
  if (!above || !below || !(*above < *below)) return std::nullopt;
  return before + *above / *below;
}

/// Removes feet from the text's front; the rest is inches.
std::optional<double> take_feet(std::string_view& text) {
  for (const std::string_view word : {"'", "\xE2\x80\xB2", "feet", "ft"}) {
    const std::size_t at = text.find(word);
    if (at == npos || text.substr(at).starts_with("''")) continue;
    const auto feet = whole(trimmed(text.substr(0, at)));
    if (feet) text = trimmed(text.substr(at + word.size()));
    return feet;
  }
  return std::nullopt;
}

/// The inches after feet; 0 if there are none.
std::optional<double> inches_behind_feet(std::string_view text) {
  if (text.starts_with('-')) text = trimmed(text.substr(1));
  if (text.empty()) return 0.0;
  const auto unit = take_unit(text);
  if (unit && *unit != kMmPerInch) return std::nullopt;
  auto inches = fraction(text);
  if (!inches && text.find_first_not_of("0123456789.") == npos) inches = number_of(text);
  return inches && *inches < kInchesPerFoot ? inches : std::nullopt;
}

}  // namespace

std::optional<std::string> fraction_of_date(std::string_view text) {
  constexpr std::string_view kMonths = "JanFebMarAprMayJunJulAugSepOctNovDec";
  text = trimmed(text);
  const std::size_t dash = text.find('-');
  if (dash == npos) return std::nullopt;
  const bool month_first = dash == 3;
  const std::string_view name = month_first ? text.substr(0, dash) : text.substr(dash + 1);
  const std::string_view below = month_first ? text.substr(dash + 1) : text.substr(0, dash);
  const std::size_t at = kMonths.find(name);
  if (name.size() != 3 || at == npos || at % 3 != 0 || below.size() > 2 || !whole(below))
    return std::nullopt;
  return std::to_string(at / 3 + 1) + "/" + std::to_string(static_cast<int>(*whole(below)));
}

std::optional<double> length_with_unit_mm(std::string_view text) {
  text = trimmed(text);
  const bool has_long_minus = text.starts_with(kLongMinus);
  const bool is_negative = has_long_minus || text.starts_with('-');
  if (is_negative) text.remove_prefix(has_long_minus ? kLongMinus.size() : 1);
  const double sign = is_negative ? -1.0 : 1.0;
  if (const auto feet = take_feet(text)) {
    const auto inches = inches_behind_feet(text);
    if (!inches) return std::nullopt;
    return sign * (*feet * kInchesPerFoot + *inches) * kMmPerInch;
  }
  const auto unit = take_unit(text);
  if (const auto inches = fraction(text)) {
    if (unit && *unit != kMmPerInch) return std::nullopt;
    return sign * *inches * kMmPerInch;
  }
  if (!unit && !has_long_minus) return std::nullopt;
  const auto number = number_of(text);
  if (!number || text.starts_with('-') || text.starts_with('+')) return std::nullopt;
  const double mm = sign * *number * unit.value_or(1.0);
  return std::isfinite(mm) ? std::optional(mm) : std::nullopt;
}

}  // namespace chaintrue::grid::files
