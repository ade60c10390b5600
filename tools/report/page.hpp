// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One self-contained HTML page: a verdict, then sections of text, figures, tables and charts. The
/// page needs no network: style, data, chart specifications and Vega (which draws them) are inside
/// it. Same page, same bytes.
///
/// A chart is the name of a Vega specification in charts/ plus the data tables and signals that it
/// declares without values; hovering or tapping a mark shows the object of its `tooltip`.
///
/// \code
///   Page page{.title = "Compensation map", .verdict = "True to 0.21 mm.", .tone = Tone::good};
///   page.sections.push_back({"Settings", {Table{.columns = {{"setting"}, {"stated", true}},
///                                               .rows = {{{"motor x", "1489.2"}}}}}});
///   std::string html = render(page);
/// \endcode
///
/// Pure functions of their arguments: safe from any thread.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace chaintrue::report {

/// How the page's verdict reads at a glance; said in words too, so colour alone carries nothing.
enum class Tone { good, caution, bad };

/// A question that the page answers at a glance: "Named?" "yes, one cause" in the tone's colour and
/// with its sign.
struct Light {
  Tone tone = Tone::good;
  std::string question{};
  std::string answer{};
};

struct Paragraph {
  std::string text{};
};

/// A few numbers that matter most, set large: "0.21 mm" over "expected at the tool".
struct Figure {
  std::string value{};
  std::string label{};
};
struct Figures {
  std::vector<Figure> figures{};
};

struct Column {
  std::string heading{};
  bool is_number = false;  ///< set flush right
};
struct Row {
  std::vector<std::string> cells{};
  /// A flagged row stands out; its last cell should say why.
  bool is_flagged = false;
};
struct Table {
  std::vector<Column> columns{};
  std::vector<Row> rows{};
  std::string caption{};
};

using Value = std::variant<double, bool, std::string>;

/// Rows of named fields, as a chart's specification declares them.
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
};
/// Charts side by side, one below the other where the screen is narrow.
struct ChartRow {
  std::vector<Chart> charts{};
};

using Block = std::variant<Paragraph, Figures, Table, Chart, ChartRow>;

struct Section {
  std::string title{};
  std::vector<Block> blocks{};
  /// Shows its title alone until somebody opens it; on paper it is open.
  bool is_folded = false;
};

struct Page {
  std::string title{};
  std::string subtitle{};
  std::string verdict{};
  Tone tone = Tone::good;
  /// Below the verdict, in one line.
  std::vector<Light> lights{};
  /// What to do now, at most three lines.
  std::vector<std::string> advice{};
  /// Set large below the verdict.
  std::vector<Figure> figures{};
  /// What the verdict does not prove; empty: no such line.
  std::string not_proved{};
  std::vector<Section> sections{};
  /// Set closely, so that it prints on one sheet of A4.
  bool is_one_sheet = false;
  /// Where the page came from: inputs, program and version.
  std::string provenance{};
};

/// The page as HTML.
/// \throws std::invalid_argument where a number is not finite, a row has not as many cells as its
/// table has columns, or no chart specification has the name asked for.
[[nodiscard]] std::string render(const Page& page);

}  // namespace chaintrue::report
