// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/number_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/parse_double.hpp"
#include "grid/files/pattern.hpp"
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
  const auto part = match(text, "([0-9]+)(.)([0-9]+)");
  if (part.empty() || part[2].front() != between) return std::nullopt;
  const auto first = whole_number_of(part[1], least, most);
  const auto last = whole_number_of(part[3], least, most);
  return first && last ? std::optional(std::array{*first, *last}) : std::nullopt;
}

bool looks_like_decimal_comma(std::string_view text) {
  return !match(text, "[-+. 0-9]*[0-9],[0-9][-+. 0-9]*").empty();
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

std::optional<std::string> fraction_of_date(std::string_view text) {
  constexpr std::string_view kMonths = "JanFebMarAprMayJunJulAugSepOctNovDec";
  const auto part =
      match(trimmed(text), "([A-Z][a-z]{2})-([0-9]{1,2})|([0-9]{1,2})-([A-Z][a-z]{2})");
  if (part.empty()) return std::nullopt;
  const bool month_first = part[3].empty();
  const std::size_t at = kMonths.find(part[month_first ? 1 : 4]);
  if (at == npos || at % 3 != 0) return std::nullopt;
  return fmt::format("{}/{}", at / 3 + 1, number_of(part[month_first ? 2 : 3]).value());
}

std::optional<double> length_with_unit_mm(std::string_view text) {
  using input_checks::kMmPerInch;
  constexpr double kInchesPerFoot = 12.0;
  // The sign, that of word processors too; whole feet; the whole inches before a fraction, and the
  // fraction, or a decimal number; its unit.
  const auto part =
      match(trimmed(text),
            "(?=.*[0-9])(-|\xE2\x88\x92)?[ \t]*"
            "(?:([0-9]+)[ \t]*(?:'(?!')|\xE2\x80\xB2|feet|ft)[ \t]*(?:-[ \t]*)?)?"
            "(?:(?:(?:([0-9]+)[ -][ \t]*)?([0-9]+)/([0-9]+)|([0-9]*[.]?[0-9].*?))[ \t]*"
            "(mm|cm|m|inches|inch|in|\"|''|\xE2\x80\xB3)?)?");
  if (part.empty()) return std::nullopt;
  const auto number = [&part](std::size_t group) {
    return number_of("0" + std::string(part[group])).value_or(std::nan(""));
  };
  const bool has_feet = !part[2].empty(), has_fraction = !part[4].empty();
  const std::string_view unit = part[7];
  double unit_mm = unit == "mm" ? 1.0 : unit == "cm" ? 10.0 : unit == "m" ? 1000.0 : kMmPerInch;
  double value = has_fraction ? number(3) + number(4) / number(5) : number(6);
  if (has_feet || has_fraction) {
    // Nobody reads 13/8 of an inch from a rule; it may also be a date.
    const bool is_of_a_rule = unit_mm == kMmPerInch && (!has_fraction || number(4) < number(5)) &&
                              (!has_feet || value < kInchesPerFoot);
    if (!is_of_a_rule) return std::nullopt;
    value += kInchesPerFoot * number(2);
  } else if (unit.empty()) {
    if (part[1].size() < 2) return std::nullopt;
    unit_mm = 1.0;  // of its place; no other reader knows the long minus sign
  }
  const double mm = (part[1].empty() ? 1.0 : -1.0) * value * unit_mm;
  return std::isfinite(mm) ? std::optional(mm) : std::nullopt;
}

}  // namespace chaintrue::grid::files
