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

  std::string write(const Document& document) {
    paragraph(document.verdict, 0);
    heading_of_advice(document);
    if (shows(document.not_proved.detail) && !document.not_proved.text.empty()) {
      line("");
      paragraph(document.not_proved, 0);
    }
    for (const Block& block : document.remarks.blocks) write_block(block, 0);
    for (const Section& section : document.sections) write_section(section);
    return std::move(text_);
  }

 private:
  [[nodiscard]] bool shows(Detail detail) const { return detail <= detail_; }
  void line(std::string_view text) {
    text_ += text;
    text_ += '\n';
  }

  void heading_of_advice(const Document& document) {
    bool is_first = true;
    for (const Paragraph& advice : document.advice) {
      if (!shows(advice.detail)) continue;
      if (std::exchange(is_first, false)) line("\nWhat to do now");
      line(blanks(kIndent) + "- " + advice.text);
    }
  }

  void write_section(const Section& section) {
    if (!shows(section.detail)) return;
    const std::size_t begin = text_.size();
    line("");
    const Table* first = section.blocks.empty() ? nullptr : std::get_if<Table>(&section.blocks[0]);
    const bool is_titled = section.is_titled && (first == nullptr || !first->is_headed);
    if (is_titled) line(section.title);
    const std::size_t head = text_.size();
    for (const Block& block : section.blocks) write_block(block, is_titled ? kIndent : 0);
    if (text_.size() == head) text_.resize(begin);
  }

  void write_block(const Block& block, int indent) {
    std::visit(Overloaded{
                   [&](const Paragraph& text) { paragraph(text, indent); },
                   [&](const List& list) { items(list.items, list.mark, kIndent); },
                   [&](const Table& one) { table(one); },
                   [&](const Chart& chart) { alternative(chart); },
                   [&](const ChartRow& row) {
                     for (const Chart& chart : row.charts) alternative(chart);
                   },
                   [](const Figures&) {},
               },
               block);
  }

  void alternative(const Chart& chart) {
    if (chart.alternative) table(*chart.alternative);
  }

  void paragraph(const Paragraph& text, int indent) {
    if (!shows(text.detail) || text.text.empty()) return;
    line(blanks(indent) + (text.is_note ? "Note: " : "") + text.text);
  }

  void items(const std::vector<Item>& list, List::Mark mark, int indent) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string sign = mark == List::Mark::dash     ? "- "
                               : mark == List::Mark::number ? fmt::format("{:>2}. ", i + 1)
                                                            : "";
      line(blanks(indent) + sign + list[i].text);
      items(list[i].items, List::Mark::none, indent + kIndent);
    }
  }

  static std::string text_of(const Cell& cell, const Column& column) {
    return std::visit(Overloaded{[](std::monostate) { return std::string(); },
                                 [](const std::string& text) { return text; },
                                 [&](double value) { return number_of(value, column); }},
                      cell.value);
  }

  /// At least as wide as the widest cell; numbers are separated by a blank.
  [[nodiscard]] static std::vector<int> widths_of(const Table& table) {
    std::vector<int> widths;
    for (const Column& column : table.columns) widths.push_back(column.width);
    for (const Row& row : table.rows) {
      check_row(table, row);
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const Column& column = table.columns[i];
        if (column.width == 0) continue;
        const int own = width_of(text_of(row.cells[i], column));
        widths[i] = std::max(widths[i], own + (column.is_number && i > 0 ? 1 : 0));
      }
    }
    return widths;
  }

  static std::string padded(const std::string& text, const Column& column, int width) {
    const std::string rest = blanks(width - width_of(text));
    return column.is_number ? rest + text : blanks(column.gap) + text + rest;
  }

  void table(const Table& table) {
    const std::vector<int> widths = widths_of(table);
    if (std::any_of(table.columns.begin(), table.columns.end(), [&](const Column& one) {
          return shows(one.detail) && !one.heading.empty();
        })) {
      std::string head;
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const Column& column = table.columns[i];
        if (!shows(column.detail)) continue;
        const bool is_title = table.is_headed && i == 0;
        if (i == 0 && !is_title) head += blanks(kIndent);
        const int width = i == 0 && table.head_width > 0 ? table.head_width
                                                         : widths[i] + (is_title ? kIndent : 0);
        head += padded(column.heading, column, width);
      }
      head.erase(head.find_last_not_of(' ') + 1);
      line(head);
    }
    for (const Row& row : table.rows) {
      std::string text = blanks(kIndent);
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        if (!shows(table.columns[i].detail)) continue;
        text += padded(text_of(row.cells[i], table.columns[i]), table.columns[i], widths[i]);
      }
      line(text);
    }
  }

  std::string text_;
  Detail detail_;
};

}  // namespace

std::string render_text(const Document& document, Detail detail) {
  return TextWriter(detail).write(document);
}

}  // namespace chaintrue::report
