// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/report/browser.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/files.hpp"

#ifndef CHAINTRUE_BROWSER
#define CHAINTRUE_BROWSER ""
#endif

namespace chaintrue::report::testing {
namespace {

using testing_support::read_text;
using testing_support::TemporaryFolder;

/// Opens "page.html" of the folder without network, in a new profile.
std::string browser_command(const TemporaryFolder& folder, std::string_view options) {
  return fmt::format(
      "timeout 120 '{}' --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-dev-shm-usage --disable-background-networking --disable-component-update "
      "--disable-sync --disable-default-apps --host-resolver-rules='MAP * ~NOTFOUND' "
      "--user-data-dir='{}' --virtual-time-budget=20000 {} 'file://{}' >'{}' 2>'{}'",
      CHAINTRUE_BROWSER,
      folder / "profile",
      options,
      folder / "page.html",
      folder / "dom",
      folder / "log");
}

/// The pieces of text between begin and end, both left out.
std::vector<std::string_view> between(std::string_view text,
                                      std::string_view begin,
                                      std::string_view end) {
  std::vector<std::string_view> pieces;
  for (std::size_t at = text.find(begin); at != text.npos; at = text.find(begin, at)) {
    at += begin.size();
    const std::size_t stop = std::min(text.find(end, at), text.size());
    pieces.push_back(text.substr(at, stop - at));
    at = stop;
  }
  return pieces;
}

int count(std::string_view text, std::string_view piece) {
  int found = 0;
  for (std::size_t at = text.find(piece); at != text.npos; at = text.find(piece, at + piece.size()))
    ++found;
  return found;
}

int count_items(std::string_view group) {
  int items = 0;
  for (const std::string_view element : {"<path ", "<line ", "<rect ", "<text "})
    items += count(group, element);
  return items;
}

/// The leaf groups of a chart, each with the items of one mark: `symbol role-mark points" ...`.
std::vector<std::string_view> mark_groups(std::string_view figure) {
  std::vector<std::string_view> groups;
  for (const std::string_view group : between(figure, "<g class=\"mark-", "</g>")) {
    const std::string_view head = group.substr(0, group.find('"'));
    if (head.find("role-mark") != head.npos && !head.starts_with("group")) groups.push_back(group);
  }
  return groups;
}

struct DrawnChart {
  std::string_view specification;
  std::string_view id;
  std::string_view svg;
};

std::vector<DrawnChart> charts_of(std::string_view dom) {
  std::vector<DrawnChart> charts;
  for (const std::string_view figure :
       between(dom, "<figure class=\"chart\" data-spec=\"", "</figure>")) {
    const auto ids = between(figure, " id=\"", "\"");
    const auto svgs = between(figure, "<svg ", "</svg>");
    charts.push_back({figure.substr(0, figure.find('"')),
                      ids.empty() ? std::string_view{} : ids.front(),
                      svgs.empty() ? std::string_view{} : svgs.front()});
  }
  return charts;
}

/// Of tables with a mark a row; a curve is one mark.
std::size_t largest_table_rows(const nlohmann::json& chart) {
  std::size_t rows = 0;
  for (const auto& [name, table] : chart.at("data").items()) {
    if (name != "curve") rows = std::max(rows, table.size());
  }
  return rows;
}

void add_chart_problems(const DrawnChart& chart,
                        std::size_t rows,
                        std::vector<std::string>& problems) {
  if (chart.svg.empty()) {
    problems.push_back(fmt::format("{} {} was not drawn", chart.id, chart.specification));
    return;
  }
  int items = 0;
  for (const std::string_view group : mark_groups(chart.svg)) items += count_items(group);
  if (rows == 0 || static_cast<std::size_t>(items) < rows) {
    problems.push_back(fmt::format("{} {} is empty: {} marks for {} rows of data",
                                   chart.id,
                                   chart.specification,
                                   items,
                                   rows));
  }
  for (const std::string_view nowhere : {"NaN", "Infinity", "undefined"}) {
    if (chart.svg.find(nowhere) != chart.svg.npos) {
      problems.push_back(
          fmt::format("{} {} has marks at {}", chart.id, chart.specification, nowhere));
    }
  }
}

}  // namespace

bool has_browser() { return !std::string_view(CHAINTRUE_BROWSER).empty(); }

Visit visit(const std::string& html, std::string_view probe, Window window) {
  const TemporaryFolder folder;
  std::string page = html;
  if (!probe.empty()) {
    // Charts are drawn asynchronously; the page signals when they are done.
    const std::string script = fmt::format(
        "<script>(async function wait() {{ if (!document.documentElement.dataset.charts) return "
        "setTimeout(wait, 20);\n{}\n}})();"
        "</script>\n</body>",
        probe);
    page.replace(page.rfind("</body>"), 7, script);
  }
  std::ofstream(folder / "page.html", std::ios::binary) << page;
  const int status = std::system(
      browser_command(folder,
                      fmt::format("--window-size={},{} --enable-logging=stderr --dump-dom",
                                  window.width_px,
                                  window.height_px))
          .c_str());
  Visit result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.dom = read_text(folder / "dom");
  const std::string log = read_text(folder / "log");
  for (const std::string_view line : between(log, ":CONSOLE", "\n"))
    result.console.emplace_back(line);
  return result;
}

int printed_sheets(const std::string& html, const Paper& paper) {
  const TemporaryFolder folder;
  std::string page = html;
  page.insert(
      page.find("</head>"),
      fmt::format(
          "<style>@page {{ size: {}mm {}mm; }}</style>\n", paper.width_mm, paper.height_mm));
  std::ofstream(folder / "page.html", std::ios::binary) << page;
  const std::string options =
      fmt::format("--no-pdf-header-footer --print-to-pdf='{}'", folder / "page.pdf");
  if (std::system(browser_command(folder, options).c_str()) != 0) return 0;
  // Skia writes each page as an object of its own, uncompressed.
  const std::string pdf = read_text(folder / "page.pdf");
  return count(pdf, "/Type /Page\n");
}

std::vector<std::string> problems_of(const Visit& visit) {
  std::vector<std::string> problems;
  if (visit.exit_code != 0)
    problems.push_back(fmt::format("the browser ended with {}", visit.exit_code));
  for (const std::string& line : visit.console) problems.push_back("console: " + line);
  if (visit.dom.find("data-charts=\"drawn\"") == visit.dom.npos)
    problems.push_back("the page never said that its charts are drawn");
  const auto data = between(visit.dom, "id=\"data\">", "</script>");
  if (data.empty()) {
    problems.push_back("the page holds no data");
    return problems;
  }
  const auto charts = nlohmann::json::parse(data.front()).at("charts");
  const auto drawn = charts_of(visit.dom);
  if (drawn.size() != charts.size())
    problems.push_back(fmt::format("{} places for {} charts", drawn.size(), charts.size()));
  for (std::size_t i = 0; i < std::min(drawn.size(), charts.size()); ++i) {
    add_chart_problems(drawn[i], largest_table_rows(charts[i]), problems);
  }
  return problems;
}

int count_marks(const Visit& visit, std::string_view specification, std::string_view mark) {
  int items = 0;
  for (const DrawnChart& chart : charts_of(visit.dom)) {
    if (chart.specification != specification) continue;
    for (const std::string_view group : mark_groups(chart.svg)) {
      const std::string_view head = group.substr(0, group.find('"'));
      if (head.ends_with(fmt::format(" {}", mark))) items += count_items(group);
    }
  }
  return items;
}

}  // namespace chaintrue::report::testing
