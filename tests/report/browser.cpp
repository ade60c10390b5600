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

/// Opens "page.html" of the folder without network, in a new profile. Returns its exit code.
int browse(const TemporaryFolder& folder, std::string_view options) {
  const int status = std::system(
      fmt::format(
          "timeout 120 '{}' --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
          "--disable-dev-shm-usage --disable-background-networking --disable-component-update "
          "--disable-sync --disable-default-apps --host-resolver-rules='MAP * ~NOTFOUND' "
          "--user-data-dir='{}' --virtual-time-budget=20000 {} 'file://{}' >'{}' 2>'{}'",
          CHAINTRUE_BROWSER, folder / "profile", options, folder / "page.html", folder / "dom",
          folder / "log")
          .c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The pieces of text between begin and end, both left out.
std::vector<std::string> between(std::string_view text, std::string_view begin,
                                 std::string_view end) {
  std::vector<std::string> pieces;
  for (std::size_t at = text.find(begin); at != text.npos; at = text.find(begin, at)) {
    at += begin.size();
    const std::size_t stop = std::min(text.find(end, at), text.size());
    pieces.emplace_back(text.substr(at, stop - at));
    at = stop;
  }
  return pieces;
}

/// As the value of an attribute.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
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

/// Puts what is seen of each frame in the place of the frames, as JSON that HTML need not escape.
constexpr std::string_view kCollect = R"js(<script>
  function seen_of(page, heard) {
    const found = page.documentElement.dataset;
    const problems = heard.map((line) => "console: " + line), marks = {};
    if (found.charts !== "drawn") problems.push("the page never said that its charts are drawn");
    const data = page.getElementById("data");
    if (!data) problems.push("the page holds no data");
    const charts = data ? JSON.parse(data.textContent).charts : [];
    const figures = [...page.querySelectorAll("figure.chart[data-spec]")];
    if (figures.length !== charts.length) problems.push(`${figures.length} places for ${charts.length} charts`);
    figures.slice(0, charts.length).forEach((figure, i) => {
      const name = figure.dataset.spec, svg = figure.querySelector("svg");
      if (!svg) return problems.push(name + " was not drawn");
      let items = 0;
      for (const group of svg.querySelectorAll("g.role-mark:not(.mark-group)")) {
        const own = group.querySelectorAll("path, line, rect, text").length;
        const mark = name + " " + [...group.classList].at(-1);
        marks[mark] = (marks[mark] ?? 0) + own;
        items += own;
      }
      // For tables with a mark a row; a curve is one mark.
      const tables = Object.entries(charts[i].data).filter(([table]) => table !== "curve");
      const rows = Math.max(0, ...tables.map(([, table]) => table.length));
      if (rows === 0 || items < rows) problems.push(`${name} is empty: ${items} marks for ${rows} rows of data`);
      for (const nowhere of ["NaN", "Infinity", "undefined"])
        if (svg.outerHTML.includes(nowhere)) problems.push(`${name} has marks at ${nowhere}`);
    });
    return {problems, marks, found: {...found}};
  }
  (async () => {
    const frames = [...document.querySelectorAll("iframe")];
    const is_done = (frame) => frame.contentDocument?.documentElement?.dataset.probed;
    for (let i = 0; i < 700 && !frames.every(is_done); ++i) await new Promise((done) => setTimeout(done, 20));
    const seen = JSON.stringify(frames.map((frame) => seen_of(frame.contentDocument, frame.contentWindow.heard)));
    const place = document.createElement("pre");
    place.textContent = seen.replace(/[<>&\u00a0]/g, (c) => "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0"));
    document.body.replaceChildren(place);
  })();
</script>
</body>
)js";

}  // namespace

bool has_browser() { return !std::string_view(CHAINTRUE_BROWSER).empty(); }

std::vector<Visit> visit_all(const std::vector<Opened>& pages) {
  const TemporaryFolder folder;
  std::string html = "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<body>\n";
  for (const Opened& page : pages) {
    html += fmt::format(
        "<iframe width=\"{}\" height=\"{}\" style=\"border: 0\" srcdoc=\"{}\"></iframe>\n",
        page.window.width_px, page.window.height_px, escaped(with_probe(page)));
  }
  html += kCollect;
  std::ofstream(folder / "page.html", std::ios::binary) << html;
  const int code = browse(folder, "--window-size=1400,1000 --enable-logging=stderr --dump-dom");
  std::vector<std::string> of_all;
  if (code != 0) of_all.push_back(fmt::format("the browser ended with {}", code));
  for (const std::string& line : between(read_text(folder / "log"), ":CONSOLE", "\n"))
    of_all.push_back("console: " + line);
  const auto collected = between(read_text(folder / "dom"), "<pre>", "</pre>");
  if (collected.empty()) of_all.push_back("nothing was seen of the pages");
  std::vector<Visit> visits(pages.size(), Visit{of_all, {}, {}});
  if (collected.empty()) return visits;
  const auto seen = nlohmann::json::parse(collected.front());
  for (std::size_t i = 0; i < visits.size(); ++i) {
    for (const auto& problem : seen.at(i).at("problems")) visits[i].problems.push_back(problem);
    seen[i].at("marks").get_to(visits[i].marks);
    seen[i].at("found").get_to(visits[i].found);
  }
  return visits;
}

int printed_sheets(const std::string& html) {
  const TemporaryFolder folder;
  std::string page = html;
  page.insert(page.find("</head>"), fmt::format("<style>@page {{ size: {}mm {}mm; }}</style>\n",
                                                kA4WidthMm, kLetterHeightMm));
  std::ofstream(folder / "page.html", std::ios::binary) << page;
  if (browse(folder,
             fmt::format("--no-pdf-header-footer --print-to-pdf='{}'", folder / "page.pdf")) != 0)
    return 0;
  // Skia writes each page as a separate, uncompressed object.
  return static_cast<int>(between(read_text(folder / "page.pdf"), "/Type /Page\n", "\n").size());
}

}  // namespace chaintrue::report::testing
