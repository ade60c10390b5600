// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Writes a Page as HTML. Order of the file: verdict, sections, footer, then data, specifications,
/// Vega and the script.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>

#include "grid/precondition.hpp"
#include "tools/report/embedded.hpp"
#include "tools/report/glossary.hpp"
#include "tools/report/page.hpp"

namespace chaintrue::report {
namespace {

using Json = nlohmann::ordered_json;

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

/// How many bytes the UTF-8 character at the text's beginning has; 0 where they are none (RFC
/// 3629).
std::size_t character_length(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned second = byte(1);
  const bool is_overlong = (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
  const bool is_no_character =
      (first == 0xEDU && second > 0x9FU) || (first == 0xF4U && second > 0x8FU);
  return is_overlong || is_no_character ? 0 : length;
}

/// File names are bytes: those that are no UTF-8 become the replacement character.
std::string as_utf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    out += length == 0 ? std::string_view("\xEF\xBF\xBD") : text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string escaped(std::string_view bytes) {
  const std::string text = as_utf8(bytes);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Inside a script element no text may look like its end or like a comment.
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

class Writer {
 public:
  std::string write(const Page& page) {
    head(page);
    verdict(page);
    if (!page.figures.empty()) write_figures(Figures{page.figures});
    for (const Section& section : page.sections) write_section(section);
    if (!page.provenance.empty()) add("<footer><p>{}</p></footer>\n", escaped(page.provenance));
    add("</main>\n<div id=\"tip\" role=\"tooltip\"></div>\n");
    scripts();
    return std::move(html_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(html_), format, std::forward<Args>(args)...);
  }

  void head(const Page& page) {
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

  void verdict(const Page& page) {
    add("<div class=\"verdict {}\">\n<p class=\"sentence\">{}</p>\n",
        tone_class(page.tone),
        escaped(page.verdict));
    if (!page.lights.empty()) write_lights(page.lights);
    if (!page.advice.empty()) {
      add("<ul class=\"advice\">\n");
      for (const std::string& line : page.advice) add("<li>{}</li>\n", escaped(line));
      add("</ul>\n");
    }
    if (!page.not_proved.empty()) add("<p class=\"not-proved\">{}</p>\n", escaped(page.not_proved));
    add("</div>\n<noscript><p>The charts need JavaScript; sentences and tables do "
        "not.</p></noscript>\n");
  }

  void write_section(const Section& section) {
    const std::string heading = fmt::format("<h2>{}</h2>", escaped(section.title));
    if (section.is_folded) {
      add("<section>\n<details>\n<summary>{}</summary>\n", heading);
    } else {
      add("<section>\n{}\n", heading);
    }
    for (const Block& block : section.blocks) {
      std::visit(Overloaded{
                     [&](const Paragraph& text) { add("<p>{}</p>\n", explained(text.text)); },
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
    add("{}</section>\n", section.is_folded ? "</details>\n" : "");
  }

  void write_figures(const Figures& figures) {
    add("<div class=\"figures\">\n");
    for (const Figure& figure : figures.figures) {
      add("<div><b>{}</b><span>{}</span></div>\n", escaped(figure.value), escaped(figure.label));
    }
    add("</div>\n");
  }

  void write_table(const Table& table) {
    add("<div class=\"table-box\"><table>\n");
    if (!table.caption.empty()) add("<caption>{}</caption>\n", escaped(table.caption));
    add("<thead><tr>");
    for (const Column& column : table.columns) {
      add("<th{}>{}</th>", column.is_number ? " class=\"number\"" : "", escaped(column.heading));
    }
    add("</tr></thead>\n<tbody>\n");
    for (const Row& row : table.rows) {
      if (row.cells.size() != table.columns.size()) {
        throw grid::precondition(
            "a table row has {} cells for {} columns", row.cells.size(), table.columns.size());
      }
      add("<tr{}>", row.is_flagged ? " class=\"flagged\"" : "");
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        add("<td{} data-heading=\"{}\">{}</td>",
            table.columns[i].is_number ? " class=\"number\"" : "",
            escaped(table.columns[i].heading),
            escaped(row.cells[i]));
      }
      add("</tr>\n");
    }
    add("</tbody>\n</table></div>\n");
  }

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
        escaped(chart.title),
        id);
    if (!chart.caption.empty()) add("<figcaption>{}</figcaption>\n", escaped(chart.caption));
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

  /// Debian's modules expect require(); each gets the ones before it.
  void write_module(const EmbeddedFile& module) {
    html_ +=
        "(() => {\nconst module = {exports: {}}, exports = module.exports;\n"
        "const require = (name) => chaintrueModules[name === \"vega-selections\" ? "
        "\"vega-selection\" : name];\n";
    html_ += module.text;
    add("\nchaintrueModules[\"{}\"] = module.exports;\n}})();\n", module.name);
  }

  /// A paragraph with the meaning of each word of the glossary where it first stands on the page.
  std::string explained(std::string_view text) {
    std::string html = escaped(text);
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
      html.replace(at,
                   term.word.size(),
                   fmt::format("<abbr title=\"{}\">{}</abbr>", escaped(term.meaning), term.word));
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

std::string render(const Page& page) { return Writer().write(page); }

}  // namespace chaintrue::report
