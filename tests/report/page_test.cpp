// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Properties of a page, without a browser: same input same bytes, no network, escaped text, finite
/// numbers only.
#include "tests/report/sample_report.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/support/refusal.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/embedded.hpp"

namespace chaintrue::report::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing_support::refusal_of;

Document page_with_table(std::vector<Cell> cells) {
  Document page{.title = "t"};
  page.sections.push_back({"s", {Table{{{"a"}, {"b", true}}, {{std::move(cells), false}}, ""}}});
  return page;
}

Document page_with_value(double value) {
  Document page{.title = "t"};
  page.sections.push_back(
      {"s", {Chart{.specification = "error_steps", .data = {{"steps", {"rms_mm"}, {{value}}}}}}});
  return page;
}

TEST(Page, NeedsNoNetwork) {
  std::string html = render_html(sample_document());
  // The embedded programs are checked in the browser test, which has no network.
  html.resize(html.find("<script"));
  for (const char* const loader :
       {"<link rel=\"stylesheet", "<script src", "<img", "@import", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(loader)));
  }
}

TEST(Page, EscapesText) {
  MapPictures map = sample_pictures();
  map.points[0].name = "</script><script>alert(1)</script>";
  Document document = sample_document(map);
  document.title = "<b>&\"grid\"";
  const std::string html = render_html(document);
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;&amp;&quot;grid&quot;"));
  EXPECT_THAT(html, Not(HasSubstr("<script>alert(1)")));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>"));
}

/// File names are bytes; a page is UTF-8 in every case.
TEST(Page, ReplacesInvalidBytes) {
  const std::string bad[] = {"\xFF",    "\xC3", "\xC0\x80", "\xED\xA0\x80", "\xF5\x80\x80\x80",
                             "\xE2\x82"};
  for (const std::string& bytes : bad) {
    Document document = sample_document();
    document.title = "a" + bytes + "b";
    const std::string html = render_html(document);
    EXPECT_EQ(html.find(bytes + "b"), std::string::npos);
    EXPECT_THAT(html, HasSubstr("\xEF\xBF\xBD"));
    EXPECT_NO_THROW((void)nlohmann::json(html).dump()) << "strict UTF-8";
  }
  Document document = sample_document();
  document.title = "Säge \xE2\x82\xAC \xF0\x9F\x94\xA9";
  EXPECT_THAT(render_html(document), HasSubstr(document.title));
}

TEST(Page, EmbeddedScriptsCannotEndTheirElement) {
  for (const char* const kind : {"vega", "asset", "chart"}) {
    ASSERT_FALSE(embedded_files(kind).empty()) << kind;
    for (const EmbeddedFile& file : embedded_files(kind)) {
      EXPECT_EQ(file.text.find("</script"), std::string_view::npos) << file.name;
      EXPECT_FALSE(file.text.empty()) << file.name;
    }
  }
}

TEST(Page, EverySpecificationIsJsonForVegaFive) {
  for (const EmbeddedFile& chart : embedded_files("chart")) {
    const auto json = nlohmann::json::parse(chart.text);
    EXPECT_EQ(json.at("$schema"), "https://vega.github.io/schema/vega/v5.json") << chart.name;
    EXPECT_FALSE(json.at("description").get<std::string>().empty()) << chart.name;
  }
}

/// Names in a specification after `key`: {"field": "x_mm"}; or as datum.NAME inside an expression.
void collect_fields(const nlohmann::json& spec, std::set<std::string>& fields) {
  static const std::regex in_expression("datum\\.([A-Za-z_]+)");
  for (const auto& [key, value] : spec.items()) {
    if (key == "field" && value.is_string()) fields.insert(value.get<std::string>());
    if (value.is_string()) {
      const std::string text = value.get<std::string>();
      for (std::sregex_iterator at(text.begin(), text.end(), in_expression), end; at != end; ++at)
        fields.insert((*at)[1]);
    } else if (value.is_structured()) {
      collect_fields(value, fields);
    }
  }
}

/// Fields that a chart reads but that are in neither its data tables nor its own formulas.
std::set<std::string> missing_fields(const nlohmann::json& spec, const Chart& chart) {
  std::set<std::string> fields;
  collect_fields(spec, fields);
  for (const DataTable& table : chart.data) {
    for (const std::string& field : table.fields) fields.erase(field);
  }
  for (const auto& data : spec.at("data")) {
    for (const auto& transform : data.value("transform", nlohmann::json::array()))
      fields.erase(transform.value("as", ""));
  }
  return fields;
}

std::vector<Chart> charts_of(const Document& page) {
  std::vector<Chart> charts;
  for (const Section& section : page.sections) {
    for (const Block& block : section.blocks) {
      if (const auto* chart = std::get_if<Chart>(&block)) charts.push_back(*chart);
      if (const auto* row = std::get_if<ChartRow>(&block))
        charts.insert(charts.end(), row->charts.begin(), row->charts.end());
    }
  }
  return charts;
}

// Vega draws a missing field at 0 silently, so no browser test could detect it.
TEST(Page, EveryFieldThatAChartReadsIsGiven) {
  const std::vector<Chart> charts = charts_of(sample_document());
  ASSERT_EQ(charts.size(), 7u);
  for (const Chart& chart : charts) {
    const auto spec = nlohmann::json::parse(embedded_text("chart", chart.specification));
    EXPECT_THAT(missing_fields(spec, chart), IsEmpty()) << chart.specification;
  }
  Chart broken = charts.front();
  broken.data[0].fields[1] = "x_inch";
  EXPECT_THAT(
      missing_fields(nlohmann::json::parse(embedded_text("chart", broken.specification)), broken),
      ElementsAre("x_mm"));
}

TEST(Page, IncludesTheLicencesOfEmbeddedCode) {
  const std::string html = render_html(sample_document());
  EXPECT_THAT(html, HasSubstr("UW Interactive Data Lab"));
  EXPECT_THAT(html,
              HasSubstr("THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS"));
}

TEST(Page, HighlightsAFlaggedSetting) {
  const std::string html = render_html(sample_document());
  EXPECT_THAT(html,
              HasSubstr("<tr class=\"flagged\"><td data-heading=\"setting\">right motor, y</td>"));
  EXPECT_THAT(html,
              HasSubstr("<tr><td data-heading=\"setting\">left motor, x</td><td class=\"number\" "
                        "data-heading=\"in the file\">\u22121489.20</td>"));
}

TEST(Page, WithoutChartsThereIsNoScript) {
  const std::string html = render_html(page_with_table({"1", "2"}));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST(Page, RefusesNonFiniteNumbers) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(refusal_of([bad] { (void)render_html(page_with_value(bad)); }),
                HasSubstr("rms_mm is"));
  }
}

TEST(Page, RefusesRowsOfTheWrongLength) {
  EXPECT_EQ(refusal_of([] {
              (void)render_html(page_with_table({"1", "2", "3"}));
            }),
            "a table row has 3 cells for 2 columns");
  Document page = page_with_value(1.0);
  std::get<Chart>(page.sections[0].blocks[0]).data[0].rows[0].clear();
  EXPECT_EQ(refusal_of([&page] { (void)render_html(page); }),
            "data table \"steps\": a row has 0 values for 1 fields");
}

TEST(Page, RefusesAChartThatDoesNotExist) {
  Document page = page_with_value(1.0);
  std::get<Chart>(page.sections[0].blocks[0]).specification = "pie";
  EXPECT_EQ(refusal_of([&page] { (void)render_html(page); }),
            "no chart named \"pie\" is embedded in the report library");
}

TEST(BedChart, TheArrowOfABadPointEndsAtTheFrame) {
  const Outline sheet{-1000.0, 1000.0, -500.0, 500.0};
  const Arrow good{.name = "point 1", .x_mm = -500.0, .y_mm = 0.0, .dx_mm = 0.3, .dy_mm = 0.0};
  const Arrow bad{
      .name = "point 9", .x_mm = 500.0, .y_mm = 100.0, .dx_mm = 25.4, .dy_mm = 0.0, .is_bad = true};
  const double magnification = magnification_of(sheet, {good, bad});
  const Chart chart = arrows_chart(sheet, {good, bad}, magnification, kAfterColor);
  const DataTable& table = chart.data.front();
  ASSERT_EQ(table.fields.back(), "shown");
  EXPECT_EQ(std::get<double>(table.rows[0].back()), 1.0);
  const double frame_mm = 1100.0;  // a twentieth of the sheet's width beyond it
  EXPECT_DOUBLE_EQ(bad.x_mm + std::get<double>(table.rows[1].back()) * magnification * bad.dx_mm,
                   frame_mm);
  EXPECT_EQ(chart.caption, " Cut off at the frame: point 9 (25.40 mm).");
  EXPECT_EQ(arrows_chart(sheet, {good}, magnification, kAfterColor).caption, "");
}

TEST(MapPictures, RefuseASheetWithoutExtent) {
  MapPictures map = sample_pictures();
  map.sheet.x_max_mm = map.sheet.x_min_mm;
  EXPECT_THAT(refusal_of([&map] { (void)picture_sections(map); }),
              HasSubstr("a sheet with an extent"));
}

TEST(MapPictures, OmitUnknownValues) {
  EXPECT_TRUE(picture_sections(MapPictures{.sheet = {0.0, 1000.0, 0.0, 1000.0}}).empty());
}

}  // namespace
}  // namespace chaintrue::report::testing
