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
#include <set>
#include <string_view>

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
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

Json json_of(const Value& value, std::string_view where) {
  return std::visit(
      [&](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, double>) {
          if (!std::isfinite(held)) {
            throw grid::precondition("{} is {}, which no chart can draw", where, held);
          }
        }
        return held;
      },
      value);
}

Json rows_of(const DataTable& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    if (row.size() != table.fields.size()) {
      throw grid::precondition("data table \"{}\": a row has {} values for {} fields",
                               table.name,
                               row.size(),
                               table.fields.size());
    }
    Json object = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) {
      object[table.fields[i]] = json_of(row[i], table.fields[i]);
    }
    rows.push_back(std::move(object));
  }
  return rows;
}

class HtmlWriter {
 public:
  std::string write(const Document& page) {
    head(page);
    verdict(page);
    if (!page.figures.empty()) write_figures(Figures{page.figures});
    write_sections(page);
    if (!page.provenance.empty()) add("<footer><p>{}</p></footer>\n", escaped(page.provenance));
    add("</main>\n<div id=\"tip\" role=\"tooltip\"></div>\n");
    scripts();
    return std::move(html_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    html_ += fmt::format(format, std::forward<Args>(args)...);
  }

  void head(const Document& page) {
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n",
        escaped(page.title),
        embedded_text("asset", "page.css"));
    add("<body>\n<main{}>\n<header>\n<h1>{}</h1>\n",
        page.is_one_sheet ? " class=\"one-sheet\"" : "",
        escaped(page.title));
    if (!page.subtitle.empty()) add("<p class=\"subtitle\">{}</p>\n", escaped(page.subtitle));
    add("</header>\n");
  }

  static std::string_view tone_class(Tone tone) {
    static constexpr std::string_view kToneClass[] = {"good", "caution", "bad"};
    return kToneClass[static_cast<std::size_t>(tone)];
  }

  void write_lights(const std::vector<Light>& lights) {
    static constexpr std::string_view kSign[] = {"\u2713", "!", "\u2717"};
    add("<ul class=\"lights\">\n");
    for (const Light& light : lights) {
      add("<li class=\"{}\"><i aria-hidden=\"true\">{}</i><span><b>{}</b> {}</span></li>\n",
          tone_class(light.tone),
          kSign[static_cast<std::size_t>(light.tone)],
          escaped(light.question),
          escaped(light.answer));
    }
    add("</ul>\n");
  }

  void verdict(const Document& page) {
    add("<div class=\"verdict {}\">\n<p class=\"sentence\">{}</p>\n",
        tone_class(page.tone),
        set(page.verdict.text));
    if (!page.lights.empty()) write_lights(page.lights);
    if (!page.advice.empty()) {
      add("<ul class=\"advice\">\n");
      for (const Paragraph& line : page.advice) add("<li>{}</li>\n", set(line.text));
      add("</ul>\n");
    }
    if (!page.not_proved.text.empty())
      add("<p class=\"not-proved\">{}</p>\n", set(page.not_proved.text));
    add("</div>\n<noscript><p>The charts need JavaScript; sentences and tables do "
        "not.</p></noscript>\n");
  }

  /// The open ones, then the folded ones; where these are many, the last ones share a fold.
  void write_sections(const Document& page) {
    std::vector<const Section*> sections;
    for (const Section& section : page.sections) sections.push_back(&section);
    if (!page.remarks.blocks.empty()) sections.push_back(&page.remarks);
    const Section words = page.has_glossary ? glossary() : Section{};
    if (page.has_glossary) sections.push_back(&words);
    const auto folded =
        std::stable_partition(sections.begin(), sections.end(), [](const Section* section) {
          return !section->is_folded;
        });
    const auto shared =
        sections.end() - folded > kMostFolds ? folded + (kMostFolds - 1) : sections.end();
    std::for_each(sections.begin(), shared, [this](const Section* one) { write_section(*one); });
    if (shared != sections.end()) {
      add("<section class=\"folded\">\n<details>\n<summary><h2>Everything else</h2></summary>\n");
      std::for_each(shared, sections.end(), [this](const Section* one) {
        add("<h2>{}</h2>\n", set(one->title));
        write_blocks(*one);
      });
      add("</details>\n</section>\n");
    }
    if (folded == sections.end()) return;
    add("<p class=\"on-paper\">Folded sections are not printed: unfold on the screen first what "
        "is "
        "to be on paper.</p>\n");
  }

  void write_section(const Section& section) {
    const std::string heading = fmt::format("<h2>{}</h2>", set(section.title));
    if (section.is_folded) {
      add("<section class=\"folded\">\n<details>\n<summary>{}</summary>\n", heading);
    } else {
      add("<section>\n{}\n", heading);
    }
    write_blocks(section);
    add("{}</section>\n", section.is_folded ? "</details>\n" : "");
  }

  void write_blocks(const Section& section) {
    for (const Block& block : section.blocks) {
      std::visit(Overloaded{
                     [&](const Paragraph& text) {
                       add("<p>{}</p>\n",
                           explained(text.is_note ? capitalised(text.text) : text.text));
                     },
                     [&](const List& list) { write_list(list.items, list.mark); },
                     [&](const Figures& figures) { write_figures(figures); },
                     [&](const Table& table) { write_table(table); },
                     [&](const Chart& chart) { write_chart(chart); },
                     [&](const ChartRow& row) {
                       add("<div class=\"chart-row\">\n");
                       for (const Chart& chart : row.charts) write_chart(chart);
                       add("</div>\n");
                     },
                 },
                 block);
    }
  }

  void write_figures(const Figures& figures) {
    add("<div class=\"figures\">\n");
    for (const Figure& figure : figures.figures) {
      add("<div><b>{}</b><span>{}</span></div>\n", escaped(figure.value), explained(figure.label));
    }
    add("</div>\n");
  }

  void write_list(const std::vector<Item>& items, List::Mark mark) {
    const std::string_view tag = mark == List::Mark::number ? "ol" : "ul";
    add("<{}{}>\n", tag, mark == List::Mark::none ? " class=\"plain\"" : "");
    for (const Item& item : items) {
      add("<li>{}", explained(capitalised(item.text)));
      if (!item.items.empty()) write_list(item.items, List::Mark::none);
      add("</li>\n");
    }
    add("</{}>\n", tag);
  }

  void write_table(const Table& table) {
    add("<div class=\"table-box\"><table>\n");
    if (!table.caption.empty()) add("<caption>{}</caption>\n", set(table.caption));
    const bool has_headings = std::any_of(table.columns.begin(),
                                          table.columns.end(),
                                          [](const Column& one) { return !heading(one).empty(); });
    if (has_headings) {
      add("<thead><tr>");
      for (const Column& column : table.columns)
        add("<th{}>{}</th>", number_class(column), heading(column));
      add("</tr></thead>\n");
    }
    add("<tbody>\n");
    for (const Row& row : table.rows) {
      check_row(table, row);
      add("<tr{}>", row.is_flagged ? " class=\"flagged\"" : "");
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const Column& column = table.columns[i];
        add("<td{} data-heading=\"{}\">{}</td>",
            number_class(column),
            heading(column),
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
    return std::visit(Overloaded{[](std::monostate) { return std::string("\u2013"); },
                                 [](const std::string& text) { return text; },
                                 [&](double value) {
                                   std::string text = number_of(value, column);
                                   return text.front() == '-' ? "\u2212" + text.substr(1) : text;
                                 }},
                      cell.value);
  }
  static std::string set(std::string_view text) { return escaped(typeset(std::string(text))); }

  void write_chart(const Chart& chart) {
    const std::string id = fmt::format("chart-{}", charts_.size() + 1);
    specifications_[chart.specification] = Json::parse(embedded_text("chart", chart.specification));
    Json data = Json::object();
    for (const DataTable& table : chart.data) data[table.name] = rows_of(table);
    Json signals = Json::object();
    for (const Signal& signal : chart.signals)
      signals[signal.name] = json_of(signal.value, signal.name);
    charts_.push_back({{"id", id},
                       {"spec", chart.specification},
                       {"data", std::move(data)},
                       {"signals", std::move(signals)}});
    add("<figure class=\"chart\" data-spec=\"{}\">\n<h3>{}</h3>\n<div class=\"canvas\" "
        "id=\"{}\"></div>\n",
        escaped(chart.specification),
        set(chart.title),
        id);
    if (chart.alternative) {
      add("<noscript>\n");
      write_table(*chart.alternative);
      add("</noscript>\n");
    }
    if (!chart.caption.empty()) add("<figcaption>{}</figcaption>\n", set(chart.caption));
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
    html_ +=
        "(() => {\nconst module = {exports: {}}, exports = module.exports;\n"
        "const require = (name) => chaintrueModules[name === \"vega-selections\" ? "
        "\"vega-selection\" : name];\n";
    html_ += module.text;
    add("\nchaintrueModules[\"{}\"] = module.exports;\n}})();\n", module.name);
  }

  /// A paragraph with the definition of each glossary term where it first occurs on the page.
  std::string explained(std::string_view text) {
    std::string html = set(text);
    const auto is_letter = [&html](std::size_t at) {
      return at < html.size() && std::isalnum(static_cast<unsigned char>(html[at])) != 0;
    };
    for (const Term& term : terms()) {
      if (explained_.contains(term.word)) continue;
      const std::size_t at = html.find(term.word);
      if (at == std::string::npos || (at > 0 && is_letter(at - 1)) ||
          is_letter(at + term.word.size()) || is_in_an_abbr(html, at)) {
        continue;
      }
      explained_.insert(term.word);
      html.replace(
          at,
          term.word.size(),
          fmt::format(
              "<abbr title=\"{}\" tabindex=\"0\">{}</abbr>", escaped(term.meaning), term.word));
    }
    return html;
  }

  static bool is_in_an_abbr(const std::string& html, std::size_t at) {
    const std::size_t opened = html.rfind("<abbr", at);
    return opened != std::string::npos && html.find("</abbr>", opened) > at;
  }

  std::string html_;
  std::set<std::string_view> explained_;
  Json charts_ = Json::array();
  std::map<std::string, Json> specifications_;
};

}  // namespace

std::string render_html(const Document& document) { return HtmlWriter().write(document); }

}  // namespace chaintrue::report
