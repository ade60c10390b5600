// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/csv_lines.hpp"

#include <algorithm>
#include <optional>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/parse_double.hpp"
#include "grid/files/pattern.hpp"

namespace chaintrue::grid::files {

namespace {

std::size_t digits_at(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  return as_size(end - text.begin());
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
  // 0.125 is never meant as 125.
  return !match(figures, mark == ',' ? "[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:[.][0-9]*)?"
                                     : "[1-9][0-9]{0,2}(?:[.][0-9]{3})+(?:,[0-9]*)?")
              .empty();
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
  const bool point = has(figures, '.');
  const bool comma = has(figures, ',');
  if (point && comma) {
    const bool by_comma = figures.find(',') < figures.find('.');
    if (!is_grouped_by(figures, by_comma ? ',' : '.')) return;
    (by_comma ? way.decimal_point : way.decimal_comma) = true;
    (by_comma ? way.thousands_by_comma : way.thousands_by_point) = true;
  } else if (point) {
    (is_grouped_by(figures, '.') ? way.doubtful_point : way.decimal_point) = true;
  } else if (comma && count_equal(figures, ',') == 1) {
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
  if (marks.decimal == ',' && count_equal(figures, ',') > 1) return text;
  const bool is_grouped = marks.thousands && is_grouped_by(figures, *marks.thousands);
  const auto begin = as_size(figures.data() - text.data());
  std::string result = text.substr(0, begin);
  for (const char c : figures) {
    if (is_grouped && c == *marks.thousands) continue;
    result += c == marks.decimal ? '.' : c;
  }
  return result + text.substr(begin + figures.size());
}

/// Long minus signs before digits become `-`, spaces that do not break go from between thousands and
/// become spaces elsewhere: the usual one, the narrow one, thin and figure space.
std::string with_plain_signs(std::string_view text) {
  std::string result(text);
  if (any_of(text, [](char c) { return static_cast<unsigned char>(c) >= 0x80U; })) {
    result = replaced(result, "(?:\xE2\x88\x92|\xE2\x80\x93)(?=[0-9])", "-");
    result = replaced(result,
                      "([0-9])(?:\xC2\xA0|\xE2\x80\xAF|\xE2\x80\x89|\xE2\x80\x87)"
                      "(?=[0-9]{3}(?![0-9/]))",
                      "$1");
    result = replaced(result, "\xC2\xA0|\xE2\x80\xAF|\xE2\x80\x89|\xE2\x80\x87", " ");
  }
  return std::string(trimmed(result));
}

/// Decimal commas become points, and groups of thousands are joined, if the file as a whole is
/// unambiguous: if commas separate cells, `"555,5"` must occur, not only `"1,113"`; if any number
/// has a decimal point, all commas except those of thousands are unchanged.
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

}  // namespace

bool is_like_a_number(std::string_view text) { return !figures_of(text).empty(); }

bool stands_for_nothing(std::string_view text) {
  constexpr std::string_view kNothing[] = {"-", "--",  "---", "\xE2\x80\x93", "\xE2\x80\x94",
                                           "?", "n/a", "N/A", "na",           "NA"};
  return contains(kNothing, text);
}

namespace {

/// Nobody writes more lines of words above a table.
constexpr std::size_t kMostAboveHeader = 8;
/// A hundred thousand lines of eight columns, five times the most points of any verb.
constexpr std::size_t kMostCells = 800'000;
/// For a line, in bytes: more than any spreadsheet's row of columns that have a name here.
constexpr std::size_t kLongestLine = std::size_t{1} << 16U;

bool is_skipped(std::string_view line) {
  const auto first = std::find_if_not(line.begin(), line.end(), is_blank);
  return first == line.end() || *first == '#';
}

/// Calls `visit(line, number)` for every line with cells. A lone CR ends a line as well.
template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  text = without_byte_order_mark(text);
  std::size_t number = 0;
  bool is_first = true;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = text.substr(0, end);
    ++number;
    // Excel's statement of the separator.
    const bool says_separator = is_first && line.starts_with("sep=");
    is_first = false;
    if (!is_skipped(line) && !says_separator && !visit(line, number)) return;
    if (end == npos) return;
    const bool both = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
    text.remove_prefix(end + (both ? 2 : 1));
  }
}

/// The cell at the line's `begin`; `begin` moves past its separator, or past the line's end at the
/// last cell.
CsvCell take_cell(std::string_view line, char separator, std::size_t& begin,
                  bool& quote_left_open) {
  while (begin < line.size() && line[begin] != separator && is_blank(line[begin])) ++begin;
  CsvCell cell;
  cell.column = begin + 1;
  std::size_t i = begin;
  if (i < line.size() && line[i] == '"') {
    for (++i; i < line.size(); ++i) {
      if (line[i] == '"') {
        if (i + 1 >= line.size() || line[i + 1] != '"') break;
        ++i;
      }
      cell.text += line[i];
    }
    quote_left_open = quote_left_open || i >= line.size();
    i = std::min(i + 1, line.size());
  }
  const std::size_t end = std::min(line.find(separator, i), line.size());
  cell.text = with_plain_signs(trimmed(cell.text + std::string(line.substr(i, end - i))));
  begin = end + 1;
  return cell;
}

CsvRow csv_cells_of(std::string_view line, char separator, bool& quote_left_open) {
  CsvRow row;
  for (std::size_t begin = 0; begin <= line.size();)
    row.push_back(take_cell(line, separator, begin, quote_left_open));
  return row;
}

char separator_of_line(std::string_view line) {
  const char best = *max_element(std::string_view(",;\t"),
                                 ascending([&](char mark) { return count_equal(line, mark); }));
  // Numbers with decimal commas between semicolons have more commas than semicolons.
  return best == ',' && has(line, ';') ? ';' : best;
}

/// A line above the first one with numbers, and how many of its cells hold something.
struct LineOfWords {
  std::string_view text;
  std::size_t number = 0;
  std::size_t filled = 0;
};

/// The start of the table: of the lines above the first numbers the one with most cells. Without
/// such a line, or without numbers, the first line.
LineOfWords line_of_header(std::string_view text) {
  std::vector<LineOfWords> above;
  bool found_numbers = false;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    bool ignored = false;
    line = line.substr(0, kLongestLine);
    const CsvRow row = csv_cells_of(line, separator_of_line(line), ignored);
    const std::size_t numbers =
        count_where(row, [](const CsvCell& cell) { return is_like_a_number(cell.text); });
    const std::size_t filled =
        count_where(row, [](const CsvCell& cell) { return !cell.text.empty(); });
    // At least a hole's two coordinates. A row with nothing but its order, in a list that is not yet
    // filled in, does not count.
    found_numbers = numbers >= 2 && 2 * numbers > filled;
    if (!found_numbers || above.empty()) above.push_back({line, number, filled});
    return !found_numbers && above.size() <= kMostAboveHeader;
  });
  if (above.empty()) return {};
  const auto most = max_element(above, ascending(&LineOfWords::filled));
  return found_numbers && most->filled > 1 ? *most : above.front();
}

}  // namespace

std::vector<CsvRow> split_csv(std::string_view text, char separator, Problems& problems) {
  std::vector<CsvRow> rows;
  std::size_t cells = 0;
  const std::size_t first = line_of_header(text).number;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    if (number < first) {
      problems.warn(line_and_column(number, 1), "a note without a reading: left out ({})",
                    shortened(line));
      return true;
    }
    if (line.size() > kLongestLine) {
      problems.add(line_and_column(number, 1), "a longer line", ProblemKind::too_many,
                   "lines of at most {} characters", kLongestLine);
      problems.throw_if_any();
    }
    bool quote_left_open = false;
    CsvRow row = csv_cells_of(line, separator, quote_left_open);
    for (CsvCell& cell : row) cell.line = number;
    if (quote_left_open) {
      problems.add(line_and_column(number, 1), line, ProblemKind::bad_syntax,
                   "a closing quote on the same line");
    }
    cells += row.size();
    if (cells > kMostCells) {
      problems.add(line_and_column(number, 1), "more cells", ProblemKind::too_many,
                   "a table of at most {} cells", kMostCells);
      problems.throw_if_any();
    }
    rows.push_back(std::move(row));
    return true;
  });
  write_decimal_points(separator, rows);
  return rows;
}

CsvRow header_of_csv(std::string_view text) {
  bool ignored = false;
  const std::string_view line = line_of_header(text).text;
  return csv_cells_of(line, separator_of_line(line), ignored);
}

char separator_of(std::string_view text) { return separator_of_line(line_of_header(text).text); }

}  // namespace chaintrue::grid::files
