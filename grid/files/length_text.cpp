// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/length_text.hpp"

#include <algorithm>
#include <cmath>

#include "grid/files/blanks.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr double kMmPerInch = 25.4;
/// The sign that spreadsheets and word processors make of a minus.
constexpr std::string_view kLongMinus = "\xE2\x88\x92";
constexpr std::string_view kDoublePrime = "\xE2\x80\xB3";

struct Unit {
  std::string_view word;
  double mm;
};
/// Longer words first where one ends in another.
constexpr Unit kUnits[] = {{"mm", 1.0},
                           {"cm", 10.0},
                           {"m", 1000.0},
                           {"inches", kMmPerInch},
                           {"inch", kMmPerInch},
                           {"in", kMmPerInch},
                           {"\"", kMmPerInch},
                           {"''", kMmPerInch},
                           {kDoublePrime, kMmPerInch}};

/// Takes the unit off the text's end.
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
  const bool is_whole = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return c >= '0' && c <= '9';
  });
  return is_whole ? number_of(text) : std::nullopt;
}

/// `13/16` or `43 13/16`, without a sign.
std::optional<double> fraction(std::string_view text) {
  double before = 0.0;
  if (const std::size_t gap = text.find_first_of(" -"); gap != std::string_view::npos) {
    const auto inches = whole(text.substr(0, gap));
    if (!inches) return std::nullopt;
    before = *inches;
    text = trimmed(text.substr(gap + 1));
  }
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto above = whole(text.substr(0, slash));
  const auto below = whole(text.substr(slash + 1));
  // 13/8 of an inch, or a date, is nobody's reading of a rule.
  if (!above || !below || !(*above < *below)) return std::nullopt;
  return before + *above / *below;
}

}  // namespace

std::optional<double> length_with_unit_mm(std::string_view text) {
  text = trimmed(text);
  const bool has_long_minus = text.starts_with(kLongMinus);
  const bool is_negative = has_long_minus || text.starts_with('-');
  if (is_negative) text.remove_prefix(has_long_minus ? kLongMinus.size() : 1);
  const double sign = is_negative ? -1.0 : 1.0;
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
