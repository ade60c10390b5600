// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/csv_numbers.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/parse_double.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::array<std::string_view, 2> kLongMinuses = {"\xE2\x88\x92", "\xE2\x80\x93"};
/// No-break space, the narrow one, thin and figure space.
constexpr std::array<std::string_view, 4> kFirmSpaces = {
    "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89", "\xE2\x80\x87"};

std::size_t digits_at(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  return static_cast<std::size_t>(end - text.begin());
}

template <std::size_t n>
std::size_t size_of_one(std::string_view text, const std::array<std::string_view, n>& signs) {
  for (const std::string_view sign : signs) {
    if (text.starts_with(sign)) return sign.size();
  }
  return 0;
}

/// Digits, points and commas of a number, without its sign and unit; empty if it is not a number.
std::string_view figures_of(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('-') || text.starts_with('+')) text = trimmed(text.substr(1));
  const std::size_t end = std::min(text.find_first_not_of("0123456789.,"), text.size());
  const std::string_view unit = text.substr(end);
  const bool is_number = digits_at(text) > 0 && is_digit(text[end - 1]);
  return is_number && none_of(unit, is_digit) ? text.substr(0, end) : std::string_view{};
}

/// `1,113` and `1,113,000.5` for a comma.
bool is_grouped_by(std::string_view figures, char mark) {
  std::size_t at = digits_at(figures);
  if (at > 3 || at == figures.size() || figures[at] != mark) return false;
  // 0.125 is never meant as 125.
  if (figures.front() == '0') return false;
  while (at < figures.size() && figures[at] == mark) {
    if (digits_at(figures.substr(at + 1)) != 3) return false;
    at += 4;
  }
  const std::string_view rest = figures.substr(at);
  return rest.empty() || (digits_at(rest.substr(1)) == rest.size() - 1);
}

/// How the numbers of a file are written.
struct WayOfWriting {
  bool decimal_point = false;
  bool decimal_comma = false;
  bool thousands_by_comma = false;  ///< beyond doubt: a decimal point follows
  bool thousands_by_point = false;
  bool doubtful_point = false;  ///< `1.113`
  bool doubtful_comma = false;
};

void add_figures(std::string_view figures, WayOfWriting& way) {
  const bool point = figures.find('.') != std::string_view::npos;
  const bool comma = figures.find(',') != std::string_view::npos;
  if (point && comma) {
    const bool by_comma = figures.find(',') < figures.find('.');
    if (!is_grouped_by(figures, by_comma ? ',' : '.')) return;
    (by_comma ? way.decimal_point : way.decimal_comma) = true;
    (by_comma ? way.thousands_by_comma : way.thousands_by_point) = true;
  } else if (point) {
    (is_grouped_by(figures, '.') ? way.doubtful_point : way.decimal_point) = true;
  } else if (comma && std::count(figures.begin(), figures.end(), ',') == 1) {
    (is_grouped_by(figures, ',') ? way.doubtful_comma : way.decimal_comma) = true;
  }
}

/// The separators of thousands and of decimals, if the file is unambiguous.
struct NumberMarks {
  std::optional<char> thousands;
  char decimal = '.';
};
std::optional<NumberMarks> number_marks_of(const WayOfWriting& way, char separator) {
  if (way.decimal_point && way.decimal_comma) return std::nullopt;
  if (way.decimal_point)
    return way.thousands_by_comma ? std::optional(NumberMarks{',', '.'}) : std::nullopt;
  const bool between_others = separator != ',' && way.doubtful_comma && !way.doubtful_point;
  if (!way.decimal_comma && !between_others) return std::nullopt;
  if (way.thousands_by_point) return NumberMarks{'.', ','};
  return way.doubtful_point ? std::nullopt : std::optional(NumberMarks{std::nullopt, ','});
}

/// The cell with its number rewritten.
std::string rewritten(const std::string& text, const NumberMarks& marks) {
  const std::string_view figures = figures_of(text);
  if (figures.empty()) return text;
  const auto commas = std::count(figures.begin(), figures.end(), ',');
  if (marks.decimal == ',' && commas > 1) return text;
  const bool is_grouped = marks.thousands && is_grouped_by(figures, *marks.thousands);
  const auto begin = static_cast<std::size_t>(figures.data() - text.data());
  std::string result = text.substr(0, begin);
  for (const char c : figures) {
    if (is_grouped && c == *marks.thousands) continue;
    result += c == marks.decimal ? '.' : c;
  }
  return result + text.substr(begin + figures.size());
}

}  // namespace

std::string with_plain_signs(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    if (const std::size_t minus = size_of_one(text, kLongMinuses);
        minus > 0 && digits_at(text.substr(minus)) > 0) {
      result += '-';
      text.remove_prefix(minus);
    } else if (const std::size_t space = size_of_one(text, kFirmSpaces); space > 0) {
      text.remove_prefix(space);
      const bool in_number = !result.empty() && is_digit(result.back()) && digits_at(text) == 3 &&
                             (text.size() == 3 || text[3] != '/');
      if (!in_number) result += ' ';
    } else {
      result += text.front();
      text.remove_prefix(1);
    }
  }
  return std::string(trimmed(result));
}

bool is_like_a_number(std::string_view text) { return !figures_of(text).empty(); }

bool stands_for_nothing(std::string_view text) {
  constexpr std::array<std::string_view, 10> kNothing = {
      "-", "--", "---", "\xE2\x80\x93", "\xE2\x80\x94", "?", "n/a", "N/A", "na", "NA"};
  return contains(kNothing, text);
}

void write_decimal_points(char separator, std::vector<CsvRow>& rows) {
  WayOfWriting way;
  for (const CsvRow& row : rows) {
    for (const CsvCell& cell : row) add_figures(figures_of(cell.text), way);
  }
  const auto marks = number_marks_of(way, separator);
  if (!marks) return;
  for (CsvRow& row : rows) {
    for (CsvCell& cell : row) cell.text = rewritten(cell.text, *marks);
  }
}

}  // namespace chaintrue::grid::files
