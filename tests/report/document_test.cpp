// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Properties of both renderings of a document: the same content, aligned tables, details where
/// they belong, and escaped texts.
#include "tools/report/document.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <sstream>

namespace chaintrue::report::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Table numbers() {
  return {.columns = {{.heading = "Anchor", .width = 6},
                      {.heading = "fitted", .is_number = true, .width = 10},
                      {.heading = "change",
                       .is_number = true,
                       .digits = 1,
                       .has_sign = true,
                       .page_heading = "change, mm",
                       .width = 9},
                      {.heading = "only there", .is_number = true, .detail = Detail::page},
                      {.gap = 2}},
          .rows = {{{"tl x", 12.345, 1.25, 7.0, "moved"}, true},
                   {{"tr x", -1234.5, std::optional<double>(), 8.0}},
                   {{"br x", -0.001, -0.01, "n/a"}}},
          .caption = "a caption",
          .is_headed = true};
}

Document sample() {
  Document document{
      .title = "A title",
      .subtitle = "a subtitle",
      .verdict = {"The verdict is 1 +- 0.1 mm."},
      .advice = {{"Do this."}, {"And that.", Detail::page}},
      .not_proved = {"Not that it is perfect."},
      .remarks = {"What it rests on", {Paragraph{"an assumption", Detail::always, true}}},
      .provenance = "Made by a test."};
  Chart chart{.specification = "error_steps", .title = "a chart"};
  chart.alternative =
      Table{.columns = {{.width = 8}, {.gap = 2}}, .rows = {{{"in words", "97 %"}}}};
  document.sections = {{"The anchors, mm", {numbers()}},
                       {"Lines", {List{true, {{"one", {{"below one"}}}, {"two"}}}}},
                       {"Odds", {chart}},
                       {"Text", {Paragraph{"a paragraph"}, Paragraph{"a detail", Detail::verbose}}},
                       {"For those who ask", {Paragraph{"all of it"}}, false, Detail::verbose},
                       {"On the page", {Paragraph{"page paragraph"}}, true, Detail::page}};
  return document;
}

TEST(Document, RendersForTheTerminal) {
  EXPECT_EQ(render_text(sample()),
            "The verdict is 1 +- 0.1 mm.\n"
            "\nWhat to do now\n"
            "  - Do this.\n"
            "\nNot that it is perfect.\n"
            "Note: an assumption\n"
            "\nAnchor      fitted   change\n"
            "  tl x       12.35     +1.2  moved\n"
            "  tr x    -1234.50         \n"
            "  br x        0.00     +0.0\n"
            "\nLines\n"
            "   1. one\n"
            "    below one\n"
            "   2. two\n"
            "\nOdds\n"
            "  in words  97 %\n"
            "\nText\n"
            "  a paragraph\n");
}

TEST(Document, PageContainsTheTerminalText) {
  const std::string html = render_html(sample());
  for (const char* text : {"The verdict is", "Do this.",
                           "And that.",      "Not that it is perfect.",
                           "An assumption",  "The anchors, mm",
                           "change, mm",     "only there",
                           "tl x",           ">12.35<",
                           ">+1.2<",         ">moved<",
                           "a caption",      "One",
                           "Below one",      "Two",
                           "in words",       "97 %",
                           "a paragraph",    "a detail",
                           "all of it",      "page paragraph"})
    EXPECT_THAT(html, HasSubstr(text));
  EXPECT_THAT(html, HasSubstr(">\u22121234.50<")) << "a true minus sign";
  EXPECT_THAT(html, HasSubstr("1\u00a0\u00b1\u00a00.1")) << "one sign for +-";
  EXPECT_THAT(html, HasSubstr(">\u2013<")) << "an unknown number is a dash";
}

TEST(Document, DetailSelectsTheSections) {
  const std::string brief = render_text(sample());
  const std::string verbose = render_text(sample(), Detail::verbose);
  for (const char* text : {"a detail", "For those who ask\n  all of it"}) {
    EXPECT_THAT(brief, Not(HasSubstr(text)));
    EXPECT_THAT(verbose, HasSubstr(text));
  }
  for (const char* text : {"page paragraph", "On the page", "only there", "7.00", "And that."})
    EXPECT_THAT(verbose, Not(HasSubstr(text)));
  EXPECT_THAT(render_html(sample()), HasSubstr("<summary><h2>On the page</h2></summary>"));
}

/// The columns of numbers end where their headings end, for every content.
TEST(Document, TablesLineUp) {
  Table wide = numbers();
  wide.is_headed = false;
  wide.rows = {{{"as wide as a cell can be \u00b1", 123456789.125, 100.0}}, {{"short", 1.0, 2.0}}};
  Document document;
  document.sections = {{"s", {wide}}};
  std::istringstream lines(render_text(document));
  std::string line;
  std::getline(lines, line);  // empty
  std::getline(lines, line);
  EXPECT_EQ(line, "s");
  constexpr std::size_t kLabel = 2 + 26;            // two blanks and the longest label
  constexpr std::size_t kFitted = kLabel + 1 + 12;  // a blank and the longest number
  constexpr std::size_t kChange = kFitted + 9;
  std::getline(lines, line);
  EXPECT_EQ(line.find("fitted") + 6, kFitted);
  EXPECT_EQ(line.size(), kChange);
  std::getline(lines, line);
  EXPECT_EQ(line.size(), kChange + 1) << "one more byte than characters";
  std::getline(lines, line);
  EXPECT_EQ(line.find("1.00") + 4, kFitted);
  EXPECT_EQ(line.size(), kChange);
}

TEST(Document, ASectionWithoutLinesHasNoTitleOnTheTerminal) {
  Document document{.verdict = {"v"}};
  document.sections = {{"nothing", {List{}}},
                       {"empty table", {Table{.columns = {{.width = 3}}}}},
                       {"a picture", {Chart{.specification = "error_steps"}}},
                       {"on the page", {Paragraph{"p", Detail::page}}}};
  EXPECT_EQ(render_text(document), "v\n");
  EXPECT_THAT(render_html(document), HasSubstr("<tbody>\n</tbody>"));
}

TEST(Document, KeepsTextCells) {
  const std::string bad = "<b>&\"x\"</b>";
  Document document{.verdict = {bad}, .remarks = {"r", {Paragraph{bad}}}};
  document.sections = {
      {bad, {Paragraph{bad}, List{true, {{bad, {{bad}}}}}, Table{{{bad}}, {{{bad}}}, bad}}}};
  const std::string html = render_html(document);
  EXPECT_THAT(html, Not(HasSubstr("<b>&")));
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;&amp;&quot;x&quot;&lt;/b&gt;"));
  EXPECT_THAT(render_text(document), HasSubstr(bad)) << "a terminal has no markup to escape";
}

TEST(Document, RefusesNonFiniteNumbersAndLongRows) {
  const auto document = [](Row row) {
    Document made;
    made.sections = {{"s", {Table{{{"a", true}}, {std::move(row)}, ""}}}};
    return made;
  };
  const Document nan = document({{std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_THROW((void)render_text(nan), std::invalid_argument);
  EXPECT_THROW((void)render_html(nan), std::invalid_argument);
  const Document longer = document({{1.0, 2.0}});
  EXPECT_THROW((void)render_text(longer), std::invalid_argument);
  EXPECT_THROW((void)render_html(longer), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::report::testing
