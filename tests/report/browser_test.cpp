// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reports in a real browser: nothing on the console, no empty chart, values on hovering, phone
/// width; and a check that broken pages fail.
#include "tests/report/browser.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/sample_report.hpp"

namespace chaintrue::report::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class InBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  }
  const std::string html_ = render_html(sample_document());
};

std::string with(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == text.npos) throw std::logic_error("the page does not hold the text to break");
  return text.replace(at, from.size(), to);
}

TEST_F(InBrowser, EveryChartIsDrawnWithEveryRowAndNothingIsLogged) {
  const Visit visited = visit(html_);
  EXPECT_THAT(problems_of(visited), IsEmpty());
  // Before, after, and after at a larger magnification.
  EXPECT_EQ(count_marks(visited, "bed_arrows", "point_marks"), 3 * kSamplePoints);
  EXPECT_EQ(count_marks(visited, "bed_arrows", "shafts"), 3 * kSamplePoints);
  EXPECT_EQ(count_marks(visited, "error_map", "cell_marks"), kSampleCells);
  EXPECT_EQ(count_marks(visited, "error_map", "point_marks"), kSamplePoints);
  EXPECT_EQ(count_marks(visited, "held_out_target", "hit_marks"), kSamplePoints);
  EXPECT_EQ(count_marks(visited, "held_out_points", "point_marks"), kSamplePoints);
  EXPECT_EQ(count_marks(visited, "error_steps", "bars"), 4);
}

TEST_F(InBrowser, HoveringShowsTheValuesInMillimetres) {
  // The middle of the first arrow's target in the first chart.
  const Visit visited = visit(html_, R"(
    const mark = document.querySelector("#chart-1 .targets path");
    const box = mark.getBoundingClientRect();
    mark.dispatchEvent(new PointerEvent("pointermove", {bubbles: true, clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));
    mark.dispatchEvent(new MouseEvent("mousemove", {bubbles: true, clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));
    document.documentElement.dataset.tip = getComputedStyle(document.getElementById("tip")).display + ": " + document.getElementById("tip").innerText.replace(/\n/g, " ");
  )");
  EXPECT_THAT(visited.console, IsEmpty());
  EXPECT_THAT(visited.dom, HasSubstr("data-tip=\"block: point 1 "));
  const std::size_t at = visited.dom.find("data-tip=");
  ASSERT_NE(at, std::string::npos);
  const std::string tip = visited.dom.substr(at, 200);
  EXPECT_THAT(tip, HasSubstr("off by"));
  EXPECT_THAT(tip, HasSubstr(" mm"));
}

TEST_F(InBrowser, NothingStandsOutOfAPhoneScreen) {
  const Visit visited =
      visit(html_,
            "document.documentElement.dataset.overflow = "
            "document.documentElement.scrollWidth - document.documentElement.clientWidth;",
            {390, 844});
  EXPECT_THAT(problems_of(visited), IsEmpty());
  EXPECT_THAT(visited.dom, HasSubstr("data-overflow=\"0\""));
}

TEST_F(InBrowser, NoCellAndNoLabelIsCutOffOnAPhone) {
  std::string probe(kCutLabels);
  probe += kOverlappingLegends;
  probe += R"(
    for (const folded of document.querySelectorAll("details")) folded.open = true;
    const cut = [...document.querySelectorAll("td, caption, p, figcaption")].filter((cell) => {
      const box = cell.getBoundingClientRect();
      return box.width > 0 && (box.right > document.documentElement.clientWidth || cell.scrollWidth > cell.clientWidth + 1);
    });
    document.documentElement.dataset.cut = cut.length + ": " + cut.slice(0, 3).map((cell) => cell.textContent).join("; ");
  )";
  const Visit visited = visit(html_, probe, {390, 844});
  EXPECT_THAT(visited.console, IsEmpty());
  EXPECT_THAT(visited.dom, HasSubstr("data-cut=\"0: \""));
  EXPECT_THAT(visited.dom, HasSubstr("data-cut-labels=\"0: \""));
  EXPECT_THAT(visited.dom, HasSubstr("data-overlaps=\"0: \""));
}

TEST_F(InBrowser, LabelsOfAChartHideNeitherEachOtherNorPoints) {
  const Visit visited = visit(html_, R"(
    const overlaps = [];
    for (const chart of document.querySelectorAll("figure.chart")) {
      const labels = [...chart.querySelectorAll(".role-axis-label text, .role-axis-title text")].filter((t) => t.textContent && getComputedStyle(t).opacity !== "0");
      labels.forEach((one, i) => labels.slice(i + 1).forEach((other) => {
        const a = one.getBoundingClientRect(), b = other.getBoundingClientRect();
        if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 3)
          overlaps.push(chart.dataset.spec + ": " + one.textContent + " on " + other.textContent);
      }));
    }
    document.documentElement.dataset.overlaps = overlaps.length + ": " + overlaps.slice(0, 3).join("; ");
    const hidden = [];
    for (const chart of document.querySelectorAll("figure.chart")) {
      const points = [...chart.querySelectorAll(".mark-symbol path")].map((point) => point.getBoundingClientRect());
      for (const label of chart.querySelectorAll(".line_labels text, .ring_labels text")) {
        const box = label.getBoundingClientRect();
        if (points.some((point) => point.right > box.left && point.left < box.right && point.bottom > box.top && point.top < box.bottom))
          hidden.push(chart.dataset.spec + ": " + label.textContent);
      }
    }
    document.documentElement.dataset.hidden = hidden.length + ": " + hidden.join("; ");
  )");
  EXPECT_THAT(visited.console, IsEmpty());
  EXPECT_THAT(visited.dom, HasSubstr("data-overlaps=\"0: \""));
  EXPECT_THAT(visited.dom, HasSubstr("data-hidden=\"0: \""));
}

TEST_F(InBrowser, WordsAreExplainedOnceAndAtTheEnd) {
  EXPECT_THAT(html_, HasSubstr("<h2>Words</h2>"));
  const std::string abbr = "<abbr title=\"";
  std::size_t found = 0;
  for (std::size_t at = html_.find(abbr); at != std::string::npos; at = html_.find(abbr, at + 1))
    ++found;
  EXPECT_GT(found, 0U);
}

// The check must detect faults: each of these pages has one.

TEST_F(InBrowser, ABrokenSpecificationIsFound) {
  const auto problems = problems_of(visit(with(html_, "\"type\":\"rule\"", "\"type\":\"ruler\"")));
  EXPECT_THAT(problems, Contains(HasSubstr("console: ")));
}

TEST_F(InBrowser, AnEmptyChartIsFound) {
  MapPictures map = sample_pictures();
  map.error_map->cells.clear();
  map.points.clear();
  EXPECT_THAT(problems_of(visit(render_html(sample_document(map)))),
              Contains(HasSubstr("error_map is empty: ")));
}

TEST_F(InBrowser, AChartWithoutMarksIsFound) {
  const auto problems = problems_of(
      visit(with(html_, "\"from\":{\"data\":\"cells\"}", "\"from\":{\"data\":\"beyond\"}")));
  EXPECT_THAT(problems, Contains(HasSubstr("error_map is empty: ")));
}

TEST_F(InBrowser, AConsoleMessageIsFound) {
  EXPECT_THAT(problems_of(visit(html_, "console.error('the needle');")),
              Contains(HasSubstr("the needle")));
}

}  // namespace
}  // namespace chaintrue::report::testing
