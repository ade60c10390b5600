// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/report/browser.hpp"

#include <fmt/format.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#ifndef CHAINTRUE_BROWSER
#define CHAINTRUE_BROWSER ""
#endif

namespace chaintrue::report::testing {
namespace {

namespace fs = std::filesystem;

/// A temporary folder, removed with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "chaintrue-report-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr)
      throw std::runtime_error("no temporary folder can be made at " + path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string operator/(std::string_view name) const {
    return fmt::format("{}/{}", path_, name);
  }

 private:
  std::string path_;
};

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

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
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

/// For tables with a mark a row; a curve is one mark.
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

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// As the value of an attribute.
std::string escaped(const std::string& text) {
  return replaced(replaced(text, "&", "&amp;"), "\"", "&quot;");
}

/// The text of an element as the browser writes it down.
std::string unescaped(std::string_view text) {
  std::string result(text);
  for (const auto& [from, to] : {std::pair("&lt;", "<"), std::pair("&gt;", ">"),
                                 std::pair("&nbsp;", "\xC2\xA0"), std::pair("&amp;", "&")})
    result = replaced(result, from, to);
  return result;
}

/// The page keeps what it says to the console, and runs its probe once its charts are drawn.
std::string with_probe(const Opened& page) {
  std::string html = page.html;
  const std::string script = fmt::format(
      "<script>(async function wait() {{ if (!document.documentElement.dataset.charts) return "
      "setTimeout(wait, 20);\n{}\ndocument.documentElement.dataset.probed = true; }})();</script>\n"
      "</body>",
      page.probe);
  html.replace(html.rfind("</body>"), 7, script);
  return html.insert(html.find("<head>") + 6, R"(<script>
    window.heard = [];
    for (const kind of ["debug", "log", "info", "warn", "error"]) console[kind] = (...words) => heard.push(words.join(" "));
    addEventListener("error", (event) => heard.push(event.message));
    addEventListener("unhandledrejection", (event) => heard.push(String(event.reason)));
  </script>)");
}

/// Puts each frame's document and console in the place of the frames, as texts.
constexpr std::string_view kCollect = R"(<script>
  (async () => {
    const frames = [...document.querySelectorAll("iframe")];
    const is_done = (frame) => frame.contentDocument?.documentElement?.dataset.probed;
    for (let i = 0; i < 700 && !frames.every(is_done); ++i) await new Promise((done) => setTimeout(done, 20));
    const texts = frames.flatMap((frame) => [frame.contentDocument.documentElement.outerHTML, JSON.stringify(frame.contentWindow.heard)]);
    document.body.replaceChildren(...texts.map((text) => {
      const place = document.createElement("pre");
      place.textContent = text;
      return place;
    }));
  })();
</script>
</body>
)";

}  // namespace

bool has_browser() { return !std::string_view(CHAINTRUE_BROWSER).empty(); }

std::vector<Visit> visit_all(const std::vector<Opened>& pages) {
  const TemporaryFolder folder;
  std::string html = "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<body>\n";
  for (const Opened& page : pages) {
    html += fmt::format("<iframe width=\"{}\" height=\"{}\" style=\"border: 0\" srcdoc=\"{}\"></iframe>\n",
                        page.window.width_px,
                        page.window.height_px,
                        escaped(with_probe(page)));
  }
  html += kCollect;
  std::ofstream(folder / "page.html", std::ios::binary) << html;
  const int status = std::system(
      browser_command(folder, "--window-size=1400,1000 --enable-logging=stderr --dump-dom").c_str());
  const std::string dom = read_text(folder / "dom");
  const auto collected = between(dom, "<pre>", "</pre>");
  const std::string log = read_text(folder / "log");
  std::vector<Visit> visits(pages.size());
  for (std::size_t i = 0; i < visits.size(); ++i) {
    visits[i].exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    for (const std::string_view line : between(log, ":CONSOLE", "\n"))
      visits[i].console.emplace_back(line);
    if (collected.size() != 2 * pages.size()) continue;
    visits[i].dom = unescaped(collected[2 * i]);
    for (const auto& line : nlohmann::json::parse(unescaped(collected[2 * i + 1])))
      visits[i].console.push_back(line);
  }
  return visits;
}

int printed_sheets(const std::string& html) {
  const TemporaryFolder folder;
  std::string page = html;
  page.insert(page.find("</head>"),
              fmt::format("<style>@page {{ size: {}mm {}mm; }}</style>\n", kA4WidthMm, kLetterHeightMm));
  std::ofstream(folder / "page.html", std::ios::binary) << page;
  const std::string options =
      fmt::format("--no-pdf-header-footer --print-to-pdf='{}'", folder / "page.pdf");
  if (std::system(browser_command(folder, options).c_str()) != 0) return 0;
  // Skia writes each page as a separate, uncompressed object.
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
