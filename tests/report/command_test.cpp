// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue report through the command: from the demo's grid to a page in the browser; bad input
/// writes nothing.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/report/browser.hpp"

namespace chaintrue::report::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kBadInput = 3;

class ReportCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) /
              fmt::format("chaintrue_report_{}", test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  /// Runs the command with its messages going to the file "log"; returns the exit code.
  [[nodiscard]] int run(const std::string& arguments) const {
    const std::string command =
        fmt::format("'{}' {} 2>'{}'", CHAINTRUE_COMMAND, arguments, path("log"));
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string text_of(const char* name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void fit_demo_grid() const {
    ASSERT_EQ(
        run(fmt::format(
            "fit '{}/grids/seven_by_four.json' -o '{}'", CHAINTRUE_FIXTURES, path("map.json"))),
        0)
        << text_of("log");
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(ReportCommand, OfTheDemoGridIsSoundInTheBrowser) {
  fit_demo_grid();
  ASSERT_EQ(run(fmt::format("report '{}' -o '{}'", path("map.json"), path("report.html"))), 0)
      << text_of("log");
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const Visit visited = visit(text_of("report.html"));
  EXPECT_THAT(problems_of(visited), IsEmpty());
  // 28 marks and six repeated visits.
  EXPECT_EQ(count_marks(visited, "held_out_points", "point_marks"), 34);
}

TEST_F(ReportCommand, GivesTheSameBytesForTheSameMap) {
  fit_demo_grid();
  ASSERT_EQ(run(fmt::format("report '{}' -o '{}'", path("map.json"), path("first.html"))), 0);
  ASSERT_EQ(run(fmt::format("report '{}' -o '{}'", path("map.json"), path("second.html"))), 0);
  EXPECT_FALSE(text_of("first.html").empty());
  EXPECT_EQ(text_of("first.html"), text_of("second.html"));
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

struct Paper {
  const char* name;
  double width_mm, height_mm;  ///< ISO 216; ANSI Y14.1 size A
};
constexpr Paper kPapers[] = {{"A4", 210.0, 297.0}, {"Letter", 215.9, 279.4}};
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

TEST_F(ReportCommand, OnPaperNoChartIsSplitAndNothingIsCutAtTheSide) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  fit_demo_grid();
  ASSERT_EQ(run(fmt::format("diagnose '{}/grids/seven_by_four.json' -o '{}'",
                            CHAINTRUE_FIXTURES,
                            path("diagnosis.json"))),
            0)
      << text_of("log");
  ASSERT_EQ(run(fmt::format("report '{}' -o '{}'", path("map.json"), path("map.html"))), 0);
  ASSERT_EQ(run(fmt::format("report '{}' -o '{}'", path("diagnosis.json"), path("diagnosis.html"))),
            0);
  ASSERT_EQ(run(fmt::format(
                "report '{}' --certificate -o '{}'", path("map.json"), path("certificate.html"))),
            0);
  for (const Paper& paper : kPapers) {
    const Window window{static_cast<int>((paper.width_mm - 2.0 * kMarginMm) * kPxPerMm),
                        static_cast<int>((paper.height_mm - 2.0 * kMarginMm) * kPxPerMm)};
    // Blocks that must not be split fit on a page; the certificate as a whole fits on one page.
    const std::string probe = fmt::format(
        R"(
        for (const folded of document.querySelectorAll("details")) folded.open = true;
        await new Promise((done) => setTimeout(done, 300));
        const page = document.documentElement;
        const tall = [...document.querySelectorAll("figure, tr, .figures > div, .one-sheet")].filter(
            (part) => part.getBoundingClientRect().height > {});
        page.dataset.tall = tall.length + ": " + tall.map((part) => part.tagName + " " +
            Math.round(part.getBoundingClientRect().height)).join("; ");
        page.dataset.cut = page.scrollWidth - page.clientWidth;
        )",
        window.height_px);
    for (const char* name : {"map.html", "diagnosis.html", "certificate.html"}) {
      SCOPED_TRACE(::testing::Message() << name << " on " << paper.name);
      const Visit visited = visit(as_printed(text_of(name)), probe, window);
      EXPECT_THAT(problems_of(visited), IsEmpty());
      EXPECT_THAT(visited.dom, HasSubstr("data-tall=\"0: \""))
          << visited.dom.substr(0, visited.dom.find('>', visited.dom.find("<html")));
      EXPECT_THAT(visited.dom, HasSubstr("data-cut=\"0\""));
    }
  }
}

TEST_F(ReportCommand, OfAFileThatIsNoMapWritesNothing) {
  EXPECT_EQ(
      run(fmt::format(
          "report '{}/grids/seven_by_four.json' -o '{}'", CHAINTRUE_FIXTURES, path("report.html"))),
      kBadInput);
  EXPECT_THAT(text_of("log"), HasSubstr("chaintrue_map"));
  EXPECT_FALSE(std::filesystem::exists(path("report.html")));
}

TEST_F(ReportCommand, WithoutAPlaceToWriteSaysSo) {
  fit_demo_grid();
  EXPECT_EQ(run(fmt::format(
                "report '{}' -o '{}/nowhere/report.html'", path("map.json"), path("map.json"))),
            kBadInput);
  EXPECT_THAT(text_of("log"), HasSubstr("nowhere/report.html"));
}

}  // namespace
}  // namespace chaintrue::report::testing
