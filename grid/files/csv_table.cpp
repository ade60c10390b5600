// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/pattern.hpp"
#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::files {
namespace {

bool is_number(std::string_view text) { return number_of(text).has_value(); }

/// Most rows have more cells than the header, all of them numbers: `1200,5,300` is one number too
/// many.
bool looks_split_by_decimal_commas(const std::vector<CsvRow>& rows, std::size_t columns) {
  std::size_t longer = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool numbers = all_of(rows[i], [](const CsvCell& cell) { return is_number(cell.text); });
    if (numbers && rows[i].size() > columns) ++longer;
  }
  return 2 * longer > rows.size() - 1;
}

Words names_of(const std::vector<CsvColumn>& columns, bool is_required) {
  Words names;
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

/// A column's name as this project writes it, and what its numbers are multiplied by.
struct ColumnName {
  std::string name;
  double factor = 1.0;
};

/// `X (mm)`, `x [mm]` and `x_in` are x_mm.
ColumnName column_name(std::string_view text) {
  std::string name = replaced(in_small_letters(text), "[()]|\\[|\\]", "");
  name = replaced(replaced(name, "[ _]{1,50}", "_"), "^_", "");
  const auto part = match(name, "(.*)_(?:inches|inch|in)");
  if (part.empty()) return {std::move(name)};
  return {std::string(part[1]) + "_mm", input_checks::kMmPerInch};
}

/// The cell of a row in this column.
struct CellOfColumn {
  std::optional<std::size_t> index;
  double factor = 1.0;
};

/// For each column its cell. Reports a header that does not fit, once, and warns of unknown
/// columns.
std::vector<CellOfColumn> match_header(const CsvRow& header, const std::vector<CsvColumn>& columns,
                                       Problems& problems) {
  std::vector<CellOfColumn> index(columns.size());
  Words found;
  Indices unused;
  std::string remarks;
  bool is_wrong = false;
  const Words names = mapped(columns, &CsvColumn::name);
  for (const auto i : each_index(header)) {
    const std::string& name = header[i].text;
    found.push_back(name);
    const ColumnName column = column_name(name);
    const auto known = std::find(names.begin(), names.end(), column.name);
    if (known == names.end()) {
      const std::string meant = nearest(name, names);
      remarks += meant.empty() ? fmt::format("; \"{}\" is unknown", name)
                               : fmt::format("; \"{}\" is probably {}", name, meant);
      is_wrong = is_wrong || !meant.empty();
      unused.push_back(i);
    } else if (const std::size_t c = as_size(known - names.begin()); !index[c].index) {
      index[c] = {i, column.factor != 1.0 ? column.factor : columns[c].unit};
    } else {
      is_wrong = true;
      remarks += fmt::format("; \"{}\" is there twice", name);
    }
  }
  for (const auto i : each_index(columns))
    is_wrong = is_wrong || (columns[i].is_required && !index[i].index);
  if (!is_wrong) {
    for (const std::size_t i : unused) {
      if (!header[i].text.empty())
        problems.warn(header[i].place(), "the column \"{}\" is not used", header[i].text);
    }
    return index;
  }
  const bool numbers = all_of(header, [](const CsvCell& cell) {
    return is_number(cell.text) || looks_like_decimal_comma(cell.text);
  });
  if (contains(found, "x_mm") && contains(found, "y_mm") && found.size() <= 3) {
    remarks += "; these are only places, without measurements";
  } else if (any_of(found, [](const std::string& name) {
               return has(name, "distance") || has(name, "length") || has(name, "measured");
             })) {
    remarks += fmt::format("; {}", kLengthsBetween);
  }
  if (numbers) remarks = "; the first line has numbers, so the header is missing";
  if (!numbers && header.size() == names_of(columns, true).size()) {
    remarks += fmt::format("; if these are the columns in this order, the line should read {}",
                           fmt::join(names_of(columns, true), ","));
  }
  problems.add(header.front().place(), joined(found), ProblemKind::bad_table,
               expected_header(columns) + remarks);
  return {};
}

/// The number of a cell that is not empty, in the range's unit; `unit` is that of a bare number. A
/// problem is added if it is not a number or out of range.
std::optional<double> number_in_unit(const CsvCell& cell, double unit, std::string_view name,
                                     const Range& range, Problems& problems) {
  const auto bare = unit != 1.0 ? number_of(cell.text) : std::nullopt;
  if (!bare) return checked_number(cell.text, cell.place(), name, range, problems);
  if (range.holds(*bare * unit)) return *bare * unit;
  problems.add(cell.place(), fmt::format("{} ({:.6g} {})", cell.text, *bare * unit, range.unit),
               ProblemKind::out_of_range, "{} ({})", range.expected(), name);
  return std::nullopt;
}

CsvLine read_line(const CsvRow& row, const std::vector<CsvColumn>& columns,
                  const std::vector<CellOfColumn>& index, Problems& problems) {
  const std::size_t problems_before = problems.list().size();
  CsvLine line;
  for (const auto c : each_index(columns)) {
    auto& value = line.values.emplace_back();
    CsvCell& cell = line.cells.emplace_back(CsvCell{"", row.front().line, 1});
    if (!index[c].index) continue;
    const CsvColumn& column = columns[c];
    cell = row[*index[c].index];
    if (column.is_text) continue;
    if (stands_for_nothing(cell.text)) cell.text.clear();
    if (!cell.text.empty()) {
      value = number_in_unit(cell, index[c].factor, column.name, column.range, problems);
    } else if (column.is_required && !column.may_be_blank) {
      problems.add(cell.place(), "", ProblemKind::left_blank, "{} ({})", column.range.expected(),
                   column.name);
    }
  }
  line.is_clean = problems.list().size() == problems_before;
  return line;
}

/// Lines that end in a separator have one empty cell too many.
void drop_trailing_cells(std::vector<CsvRow>& rows) {
  if (rows[0].size() > 1 && rows[0].back().text.empty()) rows[0].pop_back();
  for (CsvRow& row : rows) {
    while (row.size() > rows[0].size() && row.back().text.empty()) row.pop_back();
  }
}

/// A row of another program's separators is one cell of them.
bool is_empty(const CsvCell& cell) { return cell.text.find_first_not_of(";,\t ") == npos; }

/// Rows of separators alone, and what was written below the last row of numbers: a note in words.
void drop_notes(std::vector<CsvRow>& rows, Problems& problems) {
  std::erase_if(rows, [](const CsvRow& row) { return all_of(row, is_empty); });
  while (rows.size() > 1) {
    const CsvRow& last = rows.back();
    const std::size_t filled =
        count_where(last, [](const CsvCell& cell) { return !is_empty(cell); });
    const std::string& text = last.front().text;
    const bool is_words = last.size() > 1 ? !is_like_a_number(text) && !is_empty(last.front())
                                          : has(text, ' ') && !length_with_unit_mm(text);
    if (filled != 1 || !is_words || rows[0].size() < 2) return;
    problems.warn(last.front().place(), "a note without a reading: left out ({})", shortened(text));
    rows.pop_back();
  }
}

}  // namespace

Words csv_header(std::string_view text) {
  return mapped(header_of_csv(text),
                [](const CsvCell& cell) { return column_name(cell.text).name; });
}

std::vector<CsvLine> read_csv(std::string_view text, const std::vector<CsvColumn>& columns,
                              Problems& problems) {
  std::vector<CsvRow> rows = split_csv(text, separator_of(text), problems);
  drop_notes(rows, problems);
  if (rows.empty()) {
    problems.add("", text.empty() ? "an empty file" : "only blank lines and comments",
                 ProblemKind::empty_file, expected_header(columns));
    return {};
  }
  std::vector<CsvLine> lines = read_table(std::move(rows), columns, problems);
  if (lines.empty() && !problems.any()) {
    problems.add("", "a header line only", ProblemKind::empty_file,
                 "at least one line of numbers below it");
  }
  return lines;
}

std::vector<CsvLine> read_table(std::vector<CsvRow> rows, const std::vector<CsvColumn>& columns,
                                Problems& problems) {
  drop_trailing_cells(rows);
  const std::vector<CellOfColumn> index = match_header(rows[0], columns, problems);
  if (index.empty()) return {};
  const std::size_t width = rows[0].size();
  if (looks_split_by_decimal_commas(rows, width)) {
    problems.explain(rows[1].front().place(), ProblemKind::decimal_comma,
                     fmt::format("these commas look like decimal commas: write decimals with a "
                                 "point ({} cells are under a header of {}).",
                                 rows[1].size(), width));
    return {};
  }
  std::vector<CsvLine> lines;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].size() == width) {
      lines.push_back(read_line(rows[r], columns, index, problems));
      continue;
    }
    problems.add(rows[r].front().place(), fmt::format("{} cells", rows[r].size()),
                 ProblemKind::bad_table, "{} cells, as in the header", width);
    lines.push_back({std::vector<std::optional<double>>(columns.size()),
                     CsvRow(columns.size(), CsvCell{"", rows[r].front().line, 1})});
  }
  return lines;
}

}  // namespace chaintrue::grid::files
