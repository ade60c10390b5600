// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue report through the command: from the demo's grid to a page in the browser; bad input
/// writes nothing.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <utility>
#include <vector>

#include "tests/report/browser.hpp"
#include "tests/support/files.hpp"
#include "tests/support/process.hpp"

namespace chaintrue::report::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kBadInput = 3;

class ReportCommand : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return folder_ / name; }
  /// Returns the exit code; its messages are in "err.txt".
  [[nodiscard]] int run(const std::string& arguments) const {
    return testing_support::run_line(folder_.path(), "chaintrue " + arguments).code;
  }
  [[nodiscard]] std::string text_of(const char* name) const {
    return testing_support::read_text(path(name));
  }
  void fit_demo_grid() const {
    ASSERT_EQ(
        run(fmt::format(
            "fit '{}/grids/seven_by_four.json' -o '{}'", CHAINTRUE_FIXTURES, path("map.json"))),
        0)
        << text_of("err.txt");
  }

 private:
  testing_support::TemporaryFolder folder_;
};

TEST_F(ReportCommand, OfTheDemoGridIsSoundInTheBrowser) {
  fit_demo_grid();
  ASSERT_EQ(run(fmt::format("report '{}' -o '{}'", path("map.json"), path("report.html"))), 0)
      << text_of("err.txt");
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const Visit visited = visit(text_of("report.html"));
  EXPECT_THAT(problems_of(visited), IsEmpty());
  // 28 marks and six repeated visits.
  EXPECT_EQ(count_marks(visited, "held_out_points", "point_marks"), 34);
}

TEST_F(ReportCommand, ACertificateWithoutADateHasALineToWriteItOn) {
  fit_demo_grid();
  ASSERT_EQ(
      run(fmt::format("report '{}' --certificate -o '{}'", path("map.json"), path("page.html"))),
      0);
  EXPECT_THAT(text_of("page.html"), HasSubstr("classic Maslow, date: ____"));
}

TEST_F(ReportCommand, ACertificateBearsTheDateThatItIsGiven) {
  fit_demo_grid();
  ASSERT_EQ(run(fmt::format("report '{}' --certificate --date 2026-11-22 -o '{}'",
                            path("map.json"),
                            path("page.html"))),
            0);
  EXPECT_THAT(text_of("page.html"), HasSubstr("classic Maslow, 2026-11-22</p>"));
  EXPECT_THAT(text_of("page.html"), HasSubstr("<h2>The machine's settings</h2>"));
}

constexpr double kMarginMm = 14.0;  // @page of page.css
constexpr double kPxPerMm = 96.0 / 25.4;

/// The page with the rules of @media print, for a window as wide as the paper between its margins.
std::string as_printed(std::string html) {
  constexpr std::string_view kPrint = "@media print";
  std::size_t rules = 0;
  for (std::size_t at = html.find(kPrint); at != std::string::npos; at = html.find(kPrint, at)) {
    html.replace(at, kPrint.size(), "@media all");
    ++rules;
  }
  EXPECT_GT(rules, 0U) << "the page has no rules for print";
  return html;
}

/// As narrow as A4 between its margins and as short as Letter, and shorter by as much as a chart is
/// lower on the narrower sheet: what fits here fits on both.
Window narrowest_and_shortest() {
  const double width_mm = kPapers[0].width_mm - 2.0 * kMarginMm;
  const double height_mm =
      (kPapers[1].height_mm - 2.0 * kMarginMm) * width_mm / (kPapers[1].width_mm - 2.0 * kMarginMm);
  return {static_cast<int>(width_mm * kPxPerMm), static_cast<int>(height_mm * kPxPerMm)};
}

// Blocks that must not be split fit on a page; the certificate as a whole fits on one; no table is
// wider than its box, which would cut it.
TEST_F(ReportCommand, OnPaperNoChartIsSplitAndNothingIsCutAtTheSide) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  fit_demo_grid();
  ASSERT_EQ(run(fmt::format("diagnose '{}/grids/seven_by_four.json' --report '{}' >'{}'",
                            CHAINTRUE_FIXTURES,
                            path("diagnosis.html"),
                            path("out"))),
            0)
      << text_of("err.txt");
  ASSERT_EQ(run(fmt::format("report '{}' -o '{}'", path("map.json"), path("map.html"))), 0);
  ASSERT_EQ(run(fmt::format(
                "report '{}' --certificate -o '{}'", path("map.json"), path("certificate.html"))),
            0);
  const Window window = narrowest_and_shortest();
  const std::string probe = fmt::format(
      R"(
      for (const folded of document.querySelectorAll("details")) folded.open = true;
      await new Promise((done) => setTimeout(done, 300));
      const page = document.documentElement;
      const tall = [...document.querySelectorAll("figure, tr, .figures > div, .one-sheet")].filter(
          (part) => part.getBoundingClientRect().height > {});
      page.dataset.tall = tall.length + ": " + tall.map((part) => part.tagName + " " +
          Math.round(part.getBoundingClientRect().height)).join("; ");
      const wide = [...document.querySelectorAll(".table-box, figure")].filter(
          (box) => box.scrollWidth > box.clientWidth + 1);
      page.dataset.cut = page.scrollWidth - page.clientWidth + wide.length;
      )",
      window.height_px);
  // The browsers start together: most of a visit is waiting.
  std::vector<std::pair<const char*, std::future<Visit>>> visits;
  for (const char* name : {"map.html", "diagnosis.html", "certificate.html"}) {
    visits.emplace_back(name, std::async(std::launch::async, [this, name, &probe, window] {
                          return visit(as_printed(text_of(name)), probe, window);
                        }));
  }
  for (auto& [name, visited] : visits) {
    SCOPED_TRACE(name);
    const Visit page = visited.get();
    EXPECT_THAT(problems_of(page), IsEmpty());
    const std::size_t head = page.dom.find("<html");
    EXPECT_THAT(page.dom, HasSubstr("data-tall=\"0: \""))
        << page.dom.substr(0, page.dom.find('>', head));
    EXPECT_THAT(page.dom, HasSubstr("data-cut=\"0\""));
  }
}

// What is folded on the screen stays off the paper, and the page says so.
TEST_F(ReportCommand, ADiagnosisIsPrintedOnAFewSheets) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  ASSERT_EQ(run(fmt::format("diagnose '{}/grids/seven_by_four.json' --report '{}' >'{}'",
                            CHAINTRUE_FIXTURES,
                            path("diagnosis.html"),
                            path("out"))),
            0)
      << text_of("err.txt");
  const std::string html = text_of("diagnosis.html");
  EXPECT_THAT(html, HasSubstr("What is folded on the screen is not printed"));
  const int sheets = printed_sheets(html, kPapers[0]);
  EXPECT_GE(sheets, 1);
  EXPECT_LE(sheets, 4);
}

TEST_F(ReportCommand, TheSheetsOfAnEveningAreOnePageEach) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  ASSERT_EQ(run(fmt::format(
                "start '{}/good/groundcontrol_ring.ini' '{}'", CHAINTRUE_FIXTURES, path("shop"))),
            0)
      << text_of("err.txt");
  std::vector<std::pair<std::string, std::future<int>>> printed;
  for (const char* name : {"shop/marks.html", "shop/holes.html"}) {
    for (const Paper& paper : kPapers) {
      printed.emplace_back(fmt::format("{} on {}", name, paper.name),
                           std::async(std::launch::async, [this, name, paper] {
                             return printed_sheets(text_of(name), paper);
                           }));
    }
  }
  for (auto& [name, sheets] : printed) EXPECT_EQ(sheets.get(), 1) << name;
}

TEST_F(ReportCommand, OfAFileThatIsNoMapWritesNothing) {
  EXPECT_EQ(
      run(fmt::format(
          "report '{}/grids/seven_by_four.json' -o '{}'", CHAINTRUE_FIXTURES, path("report.html"))),
      kBadInput);
  EXPECT_THAT(text_of("err.txt"), HasSubstr("chaintrue_map"));
  EXPECT_FALSE(std::filesystem::exists(path("report.html")));
}

TEST_F(ReportCommand, WithoutAPlaceToWriteSaysSo) {
  fit_demo_grid();
  EXPECT_EQ(run(fmt::format(
                "report '{}' -o '{}/nowhere/report.html'", path("map.json"), path("map.json"))),
            kBadInput);
  EXPECT_THAT(text_of("err.txt"), HasSubstr("nowhere/report.html"));
}

}  // namespace
}  // namespace chaintrue::report::testing
