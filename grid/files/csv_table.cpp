// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/blanks.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view without_byte_order_mark(std::string_view text) {
  // Some programs write a second byte order mark.
  while (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

bool is_skipped(std::string_view line) {
  const auto first = std::find_if_not(line.begin(), line.end(), is_blank);
  return first == line.end() || *first == '#';
}

/// Calls `visit(line, number)` for every line that holds cells. A lone CR ends a line as well.
template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  text = without_byte_order_mark(text);
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = text.substr(0, end);
    ++number;
    if (!is_skipped(line) && !visit(line, number)) return;
    if (end == std::string_view::npos) return;
    const bool both = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
    text.remove_prefix(end + (both ? 2 : 1));
  }
}

/// The cell at the line's `begin`; `begin` moves past its separator, or past the line's end at the
/// last cell.
CsvCell take_cell(std::string_view line,
                  char separator,
                  std::size_t& begin,
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
  cell.text = trimmed(cell.text + std::string(line.substr(i, end - i)));
  begin = end + 1;
  return cell;
}

bool is_number(std::string_view text) { return number_of(text).has_value(); }

/// Most rows have more cells than the header, all of them numbers: `1200,5,300` is one number too
/// many.
bool looks_split_by_decimal_commas(const std::vector<CsvRow>& rows, std::size_t columns) {
  std::size_t longer = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool numbers = std::all_of(
        rows[i].begin(), rows[i].end(), [](const CsvCell& cell) { return is_number(cell.text); });
    if (numbers && rows[i].size() > columns) ++longer;
  }
  return 2 * longer > rows.size() - 1;
}

std::vector<std::string> names_of(const std::vector<CsvColumn>& columns, bool is_required) {
  std::vector<std::string> names;
  for (const CsvColumn& column : columns) {
    if (column.is_required == is_required) names.push_back(column.name);
  }
  return names;
}

std::string expected_header(const std::vector<CsvColumn>& columns) {
  std::string text = "a header line with the columns " + joined(names_of(columns, true));
  const auto others = names_of(columns, false);
  return others.empty() ? text : text + " (and where wanted " + joined(others) + ")";
}

constexpr std::size_t kNoCell = static_cast<std::size_t>(-1);

/// For each column the index of its cell. Reports a header that does not fit, once.
std::vector<std::size_t> match_header(const CsvRow& header,
                                      const std::vector<CsvColumn>& columns,
                                      Problems& problems) {
  std::vector<std::size_t> index(columns.size(), kNoCell);
  std::vector<std::string> found;
  std::string remarks;
  std::vector<std::string> names;
  for (const CsvColumn& column : columns) names.push_back(column.name);
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string& name = header[i].text;
    found.push_back(name);
    const auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end()) {
      const std::string meant = nearest(name, names);
      remarks += meant.empty() ? fmt::format("; \"{}\" is unknown", name)
                               : fmt::format("; \"{}\" is probably {}", name, meant);
    } else if (std::size_t& place = index[static_cast<std::size_t>(known - names.begin())];
               place == kNoCell) {
      place = i;
    } else {
      remarks += fmt::format("; \"{}\" stands there twice", name);
    }
  }
  bool missing = false;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    missing = missing || (columns[i].is_required && index[i] == kNoCell);
  }
  if (!missing && remarks.empty()) return index;
  const bool numbers = std::all_of(header.begin(), header.end(), [](const CsvCell& cell) {
    return is_number(cell.text) || looks_like_decimal_comma(cell.text);
  });
  if (numbers) remarks = "; the first line holds numbers, the header is missing";
  if (!numbers && header.size() == names_of(columns, true).size()) {
    remarks += fmt::format("; if these are the columns in this order, the line should read {}",
                           fmt::join(names_of(columns, true), ","));
  }
  problems.add(header.front().place(), joined(found), expected_header(columns) + remarks);
  return {};
}

/// The values of a line, by column.
std::vector<std::optional<double>> read_row(const CsvRow& row,
                                            const std::vector<CsvColumn>& columns,
                                            const std::vector<std::size_t>& index,
                                            CsvRow& cells,
                                            Problems& problems) {
  std::vector<std::optional<double>> values(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (index[c] == kNoCell) continue;
    const CsvColumn& column = columns[c];
    cells[c] = row[index[c]];
    if (!cells[c].text.empty()) {
      values[c] =
          checked_number(cells[c].text, cells[c].place(), column.name, column.range, problems);
    } else if (column.is_required && !column.may_be_blank) {
      problems.add(
          cells[c].place(), "", fmt::format("{} ({})", column.range.expected(), column.name));
    }
  }
  return values;
}

/// Many countries' spreadsheets write 1493,63 and separate by semicolons. If any number of the file
/// has a point, the meaning of the commas is ambiguous and nothing is changed.
void take_decimal_commas(char separator, std::vector<CsvRow>& rows) {
  if (separator == ',') return;
  for (const CsvRow& row : rows) {
    for (const CsvCell& cell : row) {
      if (is_number(cell.text) && cell.text.find('.') != std::string::npos) return;
      if (looks_like_decimal_comma(cell.text) && cell.text.find('.') != std::string::npos) return;
    }
  }
  for (CsvRow& row : rows) {
    for (CsvCell& cell : row) {
      if (looks_like_decimal_comma(cell.text)) cell.text[cell.text.find(',')] = '.';
    }
  }
}

/// Lines that end in a separator have one empty cell too many.
void drop_trailing_cells(std::vector<CsvRow>& rows) {
  if (!rows[0].empty() && rows[0].size() > 1 && rows[0].back().text.empty()) rows[0].pop_back();
  for (CsvRow& row : rows) {
    while (row.size() > rows[0].size() && row.back().text.empty()) row.pop_back();
  }
}

}  // namespace

std::vector<CsvRow> split_csv(std::string_view text, char separator, Problems& problems) {
  std::vector<CsvRow> rows;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    CsvRow row;
    bool quote_left_open = false;
    for (std::size_t begin = 0; begin <= line.size();) {
      row.push_back(take_cell(line, separator, begin, quote_left_open));
      row.back().line = number;
    }
    if (quote_left_open) {
      problems.add(line_and_column(number, 1), line, "a closing quote on the same line");
    }
    rows.push_back(std::move(row));
    return true;
  });
  take_decimal_commas(separator, rows);
  return rows;
}

std::vector<std::string> csv_header(std::string_view text) {
  Problems ignored("");
  std::vector<std::string> names;
  const char separator = separator_of(text);
  for_each_line(text, [&](std::string_view line, std::size_t) {
    for (const CsvRow& row : split_csv(line, separator, ignored)) {
      for (const CsvCell& cell : row) names.push_back(cell.text);
    }
    return false;
  });
  return names;
}

char separator_of(std::string_view text) {
  char best = ',';
  for_each_line(text, [&best](std::string_view line, std::size_t) {
    std::ptrdiff_t most = 0;
    for (const char candidate : {',', ';', '\t'}) {
      const auto count = std::count(line.begin(), line.end(), candidate);
      if (count > most) {
        most = count;
        best = candidate;
      }
    }
    // Numbers with decimal commas between semicolons have more commas than semicolons.
    if (best == ',' && line.find(';') != std::string_view::npos) best = ';';
    return false;
  });
  return best;
}

CsvTable read_csv(std::string_view text,
                  const std::vector<CsvColumn>& columns,
                  Problems& problems) {
  CsvTable table;
  std::vector<CsvRow> rows = split_csv(text, separator_of(text), problems);
  if (rows.empty()) {
    problems.add("",
                 text.empty() ? "an empty file" : "only blank lines and comments",
                 expected_header(columns));
    return table;
  }
  drop_trailing_cells(rows);
  const std::vector<std::size_t> index = match_header(rows[0], columns, problems);
  if (index.empty()) return table;
  const std::size_t width = rows[0].size();
  if (looks_split_by_decimal_commas(rows, width)) {
    problems.add(rows[1].front().place(),
                 fmt::format("{} cells under a header of {}", rows[1].size(), width),
                 "decimals written with a point; these commas look like decimal commas");
    return table;
  }
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const std::size_t problems_before = problems.list().size();
    std::vector<std::optional<double>> values(columns.size());
    CsvRow cells(columns.size(), CsvCell{"", rows[r].front().line, 1});
    if (rows[r].size() == width) {
      values = read_row(rows[r], columns, index, cells, problems);
    } else {
      problems.add(rows[r].front().place(),
                   fmt::format("{} cells", rows[r].size()),
                   fmt::format("{} cells, as in the header", width));
    }
    table.clean.push_back(problems.list().size() == problems_before);
    table.rows.push_back(std::move(values));
    table.cells.push_back(std::move(cells));
  }
  return table;
}

}  // namespace chaintrue::grid::files
