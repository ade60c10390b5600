// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The output of a verb, built once: a verdict, then sections of text, lists, tables and charts. It
/// is rendered to the terminal and to one self-contained HTML page (style, data, chart
/// specifications and Vega, which draws them, are inside it). Same document, same bytes.
///
/// Texts are plain: escaping, and the signs for "+-" and minus, are the renderers' work. Everything
/// on the terminal is on the page too; Detail marks what only the page shows.
///
/// A chart is the name of a Vega specification in charts/ plus the data tables and signals that it
/// declares without values; hovering or tapping a mark shows the object of its `tooltip`.
///
/// \code
///   Document document{.title = "Compensation map", .verdict = {"True to 0.21 mm."}};
///   document.sections.push_back(
///       {"Settings", {Table{.columns = {{"setting"}, {.heading = "stated", .is_number = true}},
///                           .rows = {{{"motor x", 1489.2}}}}}});
///   std::string html = render_html(document), text = render_text(document);
/// \endcode
///
/// Pure functions of their arguments: safe from any thread.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace chaintrue::report {

/// Where something is shown: on the terminal and the page; on the terminal only with --verbose; on
/// the page only.
enum class Detail { always, verbose, page };

/// The colour of the verdict; its text says the same.
enum class Tone { good, caution, bad };

/// A question that the page answers at a glance: "Named?" "yes, one cause" in the tone's colour and
/// with its symbol. Page only.
struct Light {
  Tone tone = Tone::good;
  std::string question{};
  std::string answer{};
};

struct Paragraph {
  std::string text{};
  Detail detail = Detail::always;
  /// An assumption or a warning, printed as "Note:" on the terminal.
  bool is_note = false;
};

/// List items, each with its own sub-items.
struct Item {
  std::string text{};
  std::vector<Item> items{};
};
struct List {
  bool is_numbered = false;  ///< not the sub-items
  std::vector<Item> items{};
};

/// A few important numbers in large type: "0.21 mm" over "expected at the tool". Page only.
struct Figure {
  std::string value{};
  std::string label{};
};
struct Figures {
  std::vector<Figure> figures{};
};

/// A text, a number with its column's digits, or unknown.
struct Cell {
  std::variant<std::monostate, std::string, double> value{};
  Cell() = default;
  Cell(std::string text) : value(std::move(text)) {}  // NOLINT: a row reads as a list of values
  Cell(std::string_view text) : value(std::string(text)) {}  // NOLINT
  Cell(const char* text) : value(std::string(text)) {}       // NOLINT
  Cell(double number) : value(number) {}                     // NOLINT
  Cell(std::optional<double> number) {                       // NOLINT
    if (number) value = *number;
  }
};
struct Column {
  std::string heading{};
  bool is_number = false;  ///< set flush right
  int digits = 2;          ///< after the point, of cells that hold a number
  bool has_sign = false;   ///< also of positive numbers
  /// The heading on the page, with the unit; empty: the same.
  std::string page_heading{};
  /// On the terminal: the least number of characters, with the space on its left; 0: as each cell
  /// needs.
  int width = 0;
  /// On the terminal: blanks on the left of a text.
  int gap = 0;
  Detail detail = Detail::always;
};
inline Column text_column(std::string heading, int width) {
  return {.heading = std::move(heading), .width = width};
}
inline Column number_column(std::string heading, int width, int digits = 2) {
  return {.heading = std::move(heading), .is_number = true, .digits = digits, .width = width};
}
/// Shows the sign of positive numbers too.
inline Column signed_column(std::string heading, int width, int digits = 2) {
  Column column = number_column(std::move(heading), width, digits);
  column.has_sign = true;
  return column;
}
struct Row {
  /// The last cells may be left out.
  std::vector<Cell> cells{};
  /// A flagged row is highlighted; its last cell should give the reason.
  bool is_flagged = false;
};
struct Table {
  std::vector<Column> columns{};
  std::vector<Row> rows{};
  /// Below the table, on the page.
  std::string caption{};
  /// On the terminal the section's heading replaces the first column's.
  bool is_headed = false;
  /// On the terminal: width of the first heading; 0: as wide as its column.
  int head_width = 0;

  /// With the reason in a last cell where the row is flagged.
  void add(std::vector<Cell> cells, bool is_flagged = false, const char* why = nullptr) {
    if (is_flagged && why != nullptr) cells.emplace_back(why);
    rows.push_back({std::move(cells), is_flagged});
  }
};

using Value = std::variant<double, bool, std::string>;

/// Rows of named fields, as declared by a chart's specification.
struct DataTable {
  std::string name{};
  std::vector<std::string> fields{};
  std::vector<std::vector<Value>> rows{};
};
struct Signal {
  std::string name{};
  Value value;
};
struct Chart {
  std::string specification{};  ///< charts/<specification>.vg.json
  std::string title{};
  std::string caption{};
  std::vector<DataTable> data{};
  std::vector<Signal> signals{};
  /// The same as numbers: on the terminal, and on a page without scripts.
  std::optional<Table> alternative{};
};
/// Charts next to each other, or below each other on a narrow screen.
struct ChartRow {
  std::vector<Chart> charts{};
};

using Block = std::variant<Paragraph, List, Figures, Table, Chart, ChartRow>;

struct Section {
  std::string title{};
  std::vector<Block> blocks{};
  /// On the page: after the open ones, only its title until it is opened; printed only if it is
  /// open.
  bool is_folded = false;
  Detail detail = Detail::always;
  /// Whether the terminal shows the title, with the blocks indented below it.
  bool is_titled = true;

  void say(std::string text, Detail text_detail = Detail::always, bool is_note = false) {
    blocks.emplace_back(Paragraph{std::move(text), text_detail, is_note});
  }
  template <class First, class... Args>
  void say(fmt::format_string<First, Args...> text, First&& first, Args&&... more) {
    say(fmt::format(text, std::forward<First>(first), std::forward<Args>(more)...));
  }
};

struct Document {
  std::string title{};
  std::string subtitle{};
  Paragraph verdict{};
  Tone tone = Tone::good;
  /// Below the verdict, in one line.
  std::vector<Light> lights{};
  /// What to do now, at most three lines.
  std::vector<Paragraph> advice{};
  /// What the verdict does not prove; empty: no such line.
  Paragraph not_proved{};
  /// In large type below the verdict.
  std::vector<Figure> figures{};
  /// The basis of the verdict: on the terminal directly below it and without the title, on the page
  /// after the sections.
  Section remarks{};
  std::vector<Section> sections{};
  /// The page ends with the glossary.
  bool has_glossary = false;
  /// Compact, so that it prints on one sheet of A4.
  bool is_one_sheet = false;
  /// Origin of the page: inputs, program and version.
  std::string provenance{};
};

/// The document as a page. \throws std::invalid_argument if a number is not finite, a row has more
/// cells than its table has columns, or a chart specification does not exist.
std::string render_html(const Document& document);

/// The document as lines for a terminal, with the details of `detail` (always or verbose). \throws
/// std::invalid_argument if a number is not finite or a row has too many cells.
std::string render_text(const Document& document, Detail detail = Detail::always);

}  // namespace chaintrue::report
