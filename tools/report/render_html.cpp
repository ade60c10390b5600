// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Writes a Document as HTML. Order of the file: verdict, sections, footer, then data,
/// specifications, Vega and the script.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>

#include "grid/precondition.hpp"
#include "tools/report/document.hpp"
#include "tools/report/embedded.hpp"
#include "tools/report/glossary.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::report {
namespace {

using Json = nlohmann::ordered_json;

/// Titles to choose from at a glance.
constexpr std::ptrdiff_t kMostFolds = 6;

/// Inside a script element no text may contain its end tag or the start of a comment.
std::string script_json(const Json& json) {
  return replaced(json.dump(-1, ' ', false, Json::error_handler_t::replace), {{"<", "\\u003c"}});
}

Json json_of(const Value& value, std::string_view where) {
  if (const auto* number = std::get_if<double>(&value);
      number != nullptr && !std::isfinite(*number))
    throw grid::precondition("{} is {}, which no chart can draw", where, *number);
  return std::visit([](const auto& held) -> Json { return held; }, value);
}

Json rows_of(const DataTable& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    if (row.size() != table.fields.size()) {
      throw grid::precondition("data table \"{}\": a row has {} values for {} fields", table.name,
                               row.size(), table.fields.size());
    }
    Json object;
    for (std::size_t i = 0; i < row.size(); ++i) {
      object[table.fields[i]] = json_of(row[i], table.fields[i]);
    }
    rows.push_back(std::move(object));
  }
  return rows;
}

class HtmlWriter {
 public:
  std::string page(const Document& page) {
    head(page);
    verdict(page);
    write(Figures{page.figures});
    write_sections(page);
    element("<footer><p>", escaped(page.provenance), "</p></footer>\n");
    add("</main>\n<div id=\"tip\" role=\"tooltip\"></div>\n");
    scripts();
    return std::move(html_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    html_ += fmt::format(format, std::forward<Args>(args)...);
  }

  /// Nothing if it is empty.
  void element(std::string_view begin, const std::string& content, std::string_view end) {
    if (!content.empty()) add("{}{}{}", begin, content, end);
  }

  void head(const Document& page) {
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n",
        escaped(page.title), embedded_text("asset", "page.css"));
    add("<body>\n<main{}>\n<header>\n<h1>{}</h1>\n",
        page.is_one_sheet ? " class=\"one-sheet\"" : "", escaped(page.title));
    element("<p class=\"subtitle\">", escaped(page.subtitle), "</p>\n");
    add("</header>\n");
  }

  static std::string_view tone_class(Tone tone) {
    static constexpr std::string_view kToneClass[] = {"good", "caution", "bad"};
    return kToneClass[static_cast<std::size_t>(tone)];
  }

  void write_lights(const std::vector<Light>& lights) {
    static constexpr std::string_view kSign[] = {"\u2713", "!", "\u2717"};
    std::string items;
    for (const Light& light : lights) {
      items += fmt::format(
          "<li class=\"{}\"><i aria-hidden=\"true\">{}</i><span><b>{}</b> {}</span></li>\n",
          tone_class(light.tone), kSign[static_cast<std::size_t>(light.tone)],
          escaped(light.question), escaped(light.answer));
    }
    element("<ul class=\"lights\">\n", items, "</ul>\n");
  }

  void verdict(const Document& page) {
    add("<div class=\"verdict {}\">\n<p class=\"sentence\">{}</p>\n", tone_class(page.tone),
        set(page.verdict.text));
    write_lights(page.lights);
    std::string advice;
    for (const Paragraph& line : page.advice) advice += "<li>" + set(line.text) + "</li>\n";
    element("<ul class=\"advice\">\n", advice, "</ul>\n");
    element("<p class=\"not-proved\">", set(page.not_proved.text), "</p>\n");
    add("</div>\n<noscript><p>The charts need JavaScript; sentences and tables do "
        "not.</p></noscript>\n");
  }

  /// The open ones, then the folded ones; where these are many, the last ones share a fold.
  void write_sections(const Document& page) {
    std::vector<Section> sections = page.sections;
    if (!page.remarks.blocks.empty()) sections.push_back(page.remarks);
    if (page.has_glossary) sections.push_back(glossary());
    const auto end = sections.end();
    const auto folded = std::stable_partition(
        sections.begin(), end, [](const Section& section) { return !section.is_folded; });
    const auto shared = end - folded > kMostFolds ? folded + (kMostFolds - 1) : end;
    for (auto section = sections.begin(); section != end; ++section) {
      const bool is_own = section < shared;
      if (section == shared) begin_fold("Everything else");
      if (is_own && section->is_folded) {
        begin_fold(section->title);
      } else {
        add("{}<h2>{}</h2>\n", is_own ? "<section>\n" : "", set(section->title));
      }
      for (const Block& block : section->blocks)
        std::visit([this](const auto& held) { write(held); }, block);
      if (is_own) add("{}</section>\n", section->is_folded ? "</details>\n" : "");
    }
    if (shared != end) add("</details>\n</section>\n");
    if (folded == end) return;
    add("<p class=\"on-paper\">Folded sections are not printed: unfold on the screen first what is "
        "to be on paper.</p>\n");
  }

  void begin_fold(const std::string& title) {
    add("<section class=\"folded\">\n<details>\n<summary><h2>{}</h2></summary>\n", set(title));
  }

  void write(const Paragraph& text) {
    add("<p>{}</p>\n", explained(text.is_note ? capitalised(text.text) : text.text));
  }

  void write(const ChartRow& row) {
    add("<div class=\"chart-row\">\n");
    for (const Chart& chart : row.charts) write(chart);
    add("</div>\n");
  }

  void write(const List& list) { write_list(list.items, list.is_numbered); }

  void write(const Figures& figures) {
    std::string boxes;
    for (const Figure& figure : figures.figures) {
      boxes += fmt::format("<div><b>{}</b><span>{}</span></div>\n", escaped(figure.value),
                           explained(figure.label));
    }
    element("<div class=\"figures\">\n", boxes, "</div>\n");
  }

  void write_list(const std::vector<Item>& items, bool is_numbered) {
    html_ += is_numbered ? "<ol>\n" : "<ul class=\"plain\">\n";
    for (const Item& item : items) {
      add("<li>{}", explained(capitalised(item.text)));
      if (!item.items.empty()) write_list(item.items, false);
      add("</li>\n");
    }
    html_ += is_numbered ? "</ol>\n" : "</ul>\n";
  }

  void write(const Table& table) {
    add("<div class=\"table-box\"><table>\n");
    element("<caption>", set(table.caption), "</caption>\n");
    std::string head;
    bool has_headings = false;
    for (const Column& column : table.columns) {
      head += fmt::format("<th{}>{}</th>", number_class(column), heading(column));
      has_headings |= !heading(column).empty();
    }
    if (has_headings) add("<thead><tr>{}</tr></thead>\n", head);
    add("<tbody>\n");
    for (const Row& row : table.rows) {
      check_row(table, row);
      add("<tr{}>", row.is_flagged ? " class=\"flagged\"" : "");
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const Column& column = table.columns[i];
        add("<td{} data-heading=\"{}\">{}</td>", number_class(column), heading(column),
            set(i < row.cells.size() ? text_of(row.cells[i], column) : ""));
      }
      add("</tr>\n");
    }
    add("</tbody>\n</table></div>\n");
  }

  static std::string_view number_class(const Column& column) {
    return column.is_number ? " class=\"number\"" : "";
  }
  static std::string heading(const Column& column) {
    return set(column.page_heading.empty() ? column.heading : column.page_heading);
  }
  static std::string text_of(const Cell& cell, const Column& column) {
    const std::string text = typed(cell, column, "\u2013");
    return std::holds_alternative<double>(cell.value) ? with_true_minus(text) : text;
  }
  static std::string set(const std::string& text) { return escaped(typeset(text)); }

  void write(const Chart& chart) {
    const std::string id = fmt::format("chart-{}", charts_.size() + 1);
    specifications_[chart.specification] = Json::parse(embedded_text("chart", chart.specification));
    Json& json = charts_.emplace_back(Json{{"id", id},
                                           {"spec", chart.specification},
                                           {"data", Json::object()},
                                           {"signals", Json::object()}});
    for (const DataTable& table : chart.data) json["data"][table.name] = rows_of(table);
    for (const Signal& signal : chart.signals)
      json["signals"][signal.name] = json_of(signal.value, signal.name);
    add("<figure class=\"chart\" data-spec=\"{}\">\n<h3>{}</h3>\n<div class=\"canvas\" "
        "id=\"{}\"></div>\n",
        escaped(chart.specification), set(chart.title), id);
    if (chart.alternative) {
      add("<noscript>\n");
      write(*chart.alternative);
      add("</noscript>\n");
    }
    element("<figcaption>", set(chart.caption), "</figcaption>\n");
    add("</figure>\n");
  }

  void scripts() {
    if (!charts_.empty()) {
      add("<script type=\"application/json\" id=\"data\">{}</script>\n",
          script_json(Json{{"charts", charts_}}));
      add("<script type=\"application/json\" id=\"specifications\">{}</script>\n",
          script_json(Json(specifications_)));
      add("<script>\n/*\n{}*/\n", embedded_text("asset", "licences.txt"));
      add("const chaintrueModules = {{}};\n");
      for (const EmbeddedFile& module : embedded_files("vega")) write_module(module);
      add("{}</script>\n", embedded_text("asset", "page.js"));
    }
    add("</body>\n</html>\n");
  }

  /// Debian's modules expect require(); each gets the modules before it.
  void write_module(const EmbeddedFile& module) {
    add("(() => {{\nconst module = {{exports: {{}}}}, exports = module.exports;\n"
        "const require = (name) => chaintrueModules[name === \"vega-selections\" ? "
        "\"vega-selection\" : name];\n{}\nchaintrueModules[\"{}\"] = module.exports;\n}})();\n",
        module.text, module.name);
  }

  /// A paragraph with the definition of each glossary term where it first occurs on the page.
  std::string explained(const std::string& text) {
    std::string html = set(text);
    const auto is_letter = [&html](std::size_t at) {
      return at < html.size() && std::isalnum(static_cast<unsigned char>(html[at])) != 0;
    };
    std::erase_if(unexplained_, [&](const Term& term) {
      const std::size_t at = html.find(term.word), length = term.word.size();
      if (at == std::string::npos || (at > 0 && is_letter(at - 1)) || is_letter(at + length) ||
          html.find("</abbr>", at) < html.find("<abbr", at)) {  // inside one already
        return false;
      }
      html.replace(at, length,
                   fmt::format("<abbr title=\"{}\" tabindex=\"0\">{}</abbr>", escaped(term.meaning),
                               term.word));
      return true;
    });
    return html;
  }

  std::string html_;
  std::vector<Term> unexplained_{std::begin(kTerms), std::end(kTerms)};
  Json charts_ = Json::array();
  std::map<std::string, Json> specifications_;
};

}  // namespace

std::string render_html(const Document& document) { return HtmlWriter().page(document); }

}  // namespace chaintrue::report
