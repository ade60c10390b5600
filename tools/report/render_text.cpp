// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Writes a Document as lines for a terminal: the verdict, the advice, what is not proved and the
/// basis, then the sections, each after an empty line. Charts show their alternative.
#include <fmt/format.h>

#include <algorithm>

#include "tools/report/typeset.hpp"

namespace chaintrue::report {
namespace {

constexpr int kIndent = 2;

/// Number of characters: every byte of UTF-8 except continuation bytes, which begin with the bits
/// 10.
int width_of(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string blanks(int count) {
  return std::string(static_cast<std::size_t>(std::max(count, 0)), ' ');
}

class TextWriter {
 public:
  explicit TextWriter(Detail detail) : detail_(detail) {}

  std::string text(const Document& document) {
    write(document.verdict);
    write_advice(document);
    if (shows(document.not_proved.detail) && !document.not_proved.text.empty()) {
      line("");
      write(document.not_proved);
    }
    write_blocks(document.remarks, 0);
    for (const Section& section : document.sections) write_section(section);
    return std::move(text_);
  }

 private:
  bool shows(Detail detail) const { return detail <= detail_; }
  void line(std::string_view text) {
    text_ += text;
    text_ += '\n';
  }

  void write_advice(const Document& document) {
    std::string lines;
    for (const Paragraph& advice : document.advice)
      if (shows(advice.detail)) lines += "\n  - " + advice.text;
    if (!lines.empty()) line("\nWhat to do now" + lines);
  }

  void write_section(const Section& section) {
    if (!shows(section.detail)) return;
    const std::size_t begin = text_.size();
    line("");
    const Table* first = section.blocks.empty() ? nullptr : std::get_if<Table>(&section.blocks[0]);
    const bool is_titled = section.is_titled && (first == nullptr || !first->is_headed);
    if (is_titled) line(section.title);
    const std::size_t head = text_.size();
    write_blocks(section, is_titled ? kIndent : 0);
    if (text_.size() == head) text_.resize(begin);
  }

  void write_blocks(const Section& section, int indent) {
    indent_ = indent;
    for (const Block& block : section.blocks)
      std::visit([this](const auto& held) { write(held); }, block);
  }

  void write(const Paragraph& text) {
    if (!shows(text.detail) || text.text.empty()) return;
    line(blanks(indent_) + (text.is_note ? "Note: " : "") + text.text);
  }
  void write(const List& list) { items(list.items, list.is_numbered, kIndent); }
  void write(const Figures& /*on the page only*/) {}
  void write(const Chart& chart) {
    if (chart.alternative) write(*chart.alternative);
  }
  void write(const ChartRow& row) {
    for (const Chart& chart : row.charts) write(chart);
  }

  void items(const std::vector<Item>& list, bool is_numbered, int indent) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string sign = is_numbered ? fmt::format("{:>2}. ", i + 1) : "";
      line(blanks(indent) + sign + list[i].text);
      items(list[i].items, false, indent + kIndent);
    }
  }

  /// At least as wide as the widest cell; numbers are separated by a blank.
  static std::vector<int> widths_of(const Table& table) {
    std::vector<int> widths;
    for (const Column& column : table.columns) widths.push_back(column.width);
    for (const Row& row : table.rows) {
      check_row(table, row);
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const Column& column = table.columns[i];
        if (column.width == 0) continue;
        const int own = width_of(typed(row.cells[i], column));
        widths[i] = std::max(widths[i], own + (column.is_number && i > 0 ? 1 : 0));
      }
    }
    return widths;
  }

  static std::string padded(const std::string& text, const Column& column, int width) {
    const std::string rest = blanks(width - width_of(text));
    return column.is_number ? rest + text : blanks(column.gap) + text + rest;
  }

  void cells(const Table& table, const Row& row, const std::vector<int>& widths, int indent) {
    std::string text = blanks(indent);
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const Column& column = table.columns[i];
      if (shows(column.detail)) text += padded(typed(row.cells[i], column), column, widths[i]);
    }
    line(text);
  }

  void headings(const Table& table, std::vector<int> widths) {
    Row row;
    bool has_any = false;
    for (const Column& column : table.columns) {
      row.cells.emplace_back(column.heading);
      has_any |= shows(column.detail) && !column.heading.empty();
    }
    if (!has_any) return;
    if (table.is_headed) widths[0] += kIndent;
    if (table.head_width > 0) widths[0] = table.head_width;
    cells(table, row, widths, table.is_headed ? 0 : kIndent);
    text_.erase(text_.find_last_not_of(" \n") + 1);
    line("");
  }

  void write(const Table& table) {
    const std::vector<int> widths = widths_of(table);
    headings(table, widths);
    for (const Row& row : table.rows) cells(table, row, widths, kIndent);
  }

  std::string text_;
  Detail detail_;
  int indent_ = 0;
};

}  // namespace

std::string render_text(const Document& document, Detail detail) {
  return TextWriter(detail).text(document);
}

}  // namespace chaintrue::report
