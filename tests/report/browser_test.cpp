// SPDX-License-Identifier: GPL-3.0-or-later
/// Reports in a real browser: every chart drawn with every row, nothing on the console, values on hovering,
/// nothing cut off on a phone or on paper; and a check that broken pages fail. One browser opens
/// all pages.
#include "tests/report/browser.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/report/made_pages.hpp"
#include "tests/report/sample_report.hpp"
#include "tests/support/sample_diagnosis.hpp"

namespace chaintrue::report::testing {
namespace {

using grid::testing::quiet_diagnosis;
using grid::testing::sample_diagnosis;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::StartsWith;

constexpr Window kPhone{390, 844};
/// The longest name of a cause next to its bar ends in an ellipsis on a narrower one.
constexpr Window kLargePhone{500, 932};
constexpr double kMarginMm = 14.0;  // @page of page.css
constexpr double kPxPerMm = 96.0 / 25.4;

/// As narrow as A4 between its margins and as short as Letter, and shorter by as much as a chart is
/// lower on the narrower sheet: what fits here fits on both.
Window paper() {
  const double width_mm = kA4WidthMm - 2.0 * kMarginMm;
  const double height_mm =
      (kLetterHeightMm - 2.0 * kMarginMm) * width_mm / (kLetterWidthMm - 2.0 * kMarginMm);
  return {static_cast<int>(width_mm * kPxPerMm), static_cast<int>(height_mm * kPxPerMm)};
}

std::string diagnosis_of_the_demo() {
  return made_by("chaintrue diagnose " CHAINTRUE_FIXTURES
                 "/grids/seven_by_four.json --report page.html",
                 "page.html");
}

/// The page with the rules of @media print, for a window as wide as the paper between its margins.
std::string as_printed(std::string html) {
  constexpr std::string_view kPrint = "@media print";
  EXPECT_THAT(html, HasSubstr(std::string(kPrint)));
  for (std::size_t at = html.find(kPrint); at != std::string::npos; at = html.find(kPrint, at))
    html.replace(at, kPrint.size(), "@media all");
  return html;
}

std::string with(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == text.npos) throw std::logic_error("the page does not hold the text to break");
  return text.replace(at, from.size(), to);
}

/// The middle of the first arrow's target in the first chart; then what lies on what.
constexpr const char* kHoverAndOverlaps = R"(
    const mark = document.querySelector("#chart-1 .targets path");
    const box = mark.getBoundingClientRect();
    const middle = {bubbles: true, clientX: box.x + box.width / 2, clientY: box.y + box.height / 2};
    mark.dispatchEvent(new PointerEvent("pointermove", middle));
    mark.dispatchEvent(new MouseEvent("mousemove", middle));
    const tip = document.getElementById("tip");
    document.documentElement.dataset.tip = getComputedStyle(tip).display + ": " + tip.innerText.replace(/\n/g, " ");
    const lie_on = (a, b, x, y) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > x && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > y;
    const found = [];
    for (const chart of document.querySelectorAll("figure.chart")) {
      const labels = [...chart.querySelectorAll(".role-axis-label text, .role-axis-title text")].filter((t) => t.textContent && getComputedStyle(t).opacity !== "0");
      labels.forEach((one, i) => labels.slice(i + 1).forEach((other) => {
        if (lie_on(one.getBoundingClientRect(), other.getBoundingClientRect(), 1, 3)) found.push(one.textContent + " on " + other.textContent);
      }));
      for (const label of chart.querySelectorAll(".line_labels text, .ring_labels text"))
        for (const point of chart.querySelectorAll(".mark-symbol path"))
          if (lie_on(label.getBoundingClientRect(), point.getBoundingClientRect(), 0, 0)) found.push(label.textContent);
    }
    document.documentElement.dataset.hidden = found.length + ": " + found.join("; ");
)";

/// On a phone, with everything unfolded: nothing stands out of the screen, and no cell, label or legend is
/// cut off or covered.
std::string phone_probe() {
  return R"(document.documentElement.dataset.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;)" +
         std::string(kCutLabels) + std::string(kOverlappingLegends) + R"(
    const cut = [...document.querySelectorAll("td, caption, p, figcaption")].filter((cell) => {
      const box = cell.getBoundingClientRect();
      return box.width > 0 && (box.right > document.documentElement.clientWidth || cell.scrollWidth > cell.clientWidth + 1);
    });
    document.documentElement.dataset.cut = cut.length + ": " + cut.slice(0, 3).map((cell) => cell.textContent).join("; ");
  )";
}

void expect_fits_a_phone(const Visit& visited) {
  EXPECT_EQ(visited.found.at("overflow"), "0");
  EXPECT_EQ(visited.found.at("cutLabels"), "0: ");
  EXPECT_EQ(visited.found.at("overlaps"), "0: ");
}

/// Blocks that must not be split fit on a sheet, and no table is wider than its box.
std::string paper_probe() {
  return fmt::format(
      R"(
      for (const folded of document.querySelectorAll("details")) folded.open = true;
      await new Promise((done) => setTimeout(done, 300));
      const page = document.documentElement;
      const tall = [...document.querySelectorAll("figure, tr, .figures > div, .one-sheet")].filter(
          (part) => part.getBoundingClientRect().height > {});
      page.dataset.tall = tall.length + ": " + tall.map((part) => part.tagName).join("; ");
      const wide = [...document.querySelectorAll(".table-box, figure")].filter((box) => box.scrollWidth > box.clientWidth + 1);
      page.dataset.cut = page.scrollWidth - page.clientWidth + wide.length;
      )",
      paper().height_px);
}

/// Verdict, causes and what to do; the rest is folded, one line each. An unfolded chart gets its
/// width: a busy machine may be slow to redraw, so it is polled until it fits.
constexpr const char* kFoldedProbe = R"(
      const lines = [...document.querySelectorAll("section.folded")].map((section) => section.getBoundingClientRect().height);
      const page = document.documentElement;
      page.dataset.highest = Math.round(Math.max(0, ...lines));
      page.dataset.high = Math.round(page.scrollHeight - lines.reduce((sum, line) => sum + line, 0));
      const chart = document.querySelector('[data-spec="probability_bars"]');
      chart.closest("details").open = true;
      for (let i = 0; i < 200 && !page.dataset.fits; ++i) {
        await new Promise((done) => setTimeout(done, 20));
        const width = chart.querySelector("svg").getBoundingClientRect().width;
        if (width > 0 && Math.abs(width - chart.clientWidth) < 3) page.dataset.fits = true;
      }
      )";

/// Sent to `commands`, the tool lands 10 mm lower.
std::string map_of_a_tool_that_hangs_low() {
  return made_by("chaintrue start " CHAINTRUE_FIXTURES
                 "/good/groundcontrol_ring.ini shop && awk 'BEGIN { print "
                 "\"x_mm,y_mm,commanded_x_mm,commanded_y_mm\"; for (y = -510; y <= 510; y += 340) "
                 "for (x = -1080; x <= "
                 "1080; x += 360) print x \",\" y - 10 \",\" x \",\" y }' > low.csv && chaintrue "
                 "fit low.csv --machine "
                 "shop/machine.json --noise-length-mm 0.1 --noise-position-mm 0.3 -o map.json && "
                 "chaintrue report map.json "
                 "-o page.html",
                 "page.html");
}

std::string diagnosis_of_a_worn_chain() {
  return made_by("chaintrue start " CHAINTRUE_FIXTURES
                 "/good/groundcontrol_ring.ini shop && chaintrue diagnose " CHAINTRUE_FIXTURES
                 "/start/worn_chain.csv --machine shop/machine.json --report page.html",
                 "page.html");
}

/// As they are drawn, on a screen whose y counts down: shafts of the first chart that point down and hardly
/// aside, and what those of the first chart and of the errors before (third from the end) have in common, shaft by shaft.
constexpr const char* kShaftsProbe = R"(
      const charts = [...document.querySelectorAll('[data-spec="bed_arrows"]')].map((figure) =>
          [...figure.querySelectorAll(".shafts line")].map((line) =>
              ["x", "y"].map((axis) => Number(line.getAttribute(axis + "2") ?? 0) - Number(line.getAttribute(axis + "1") ?? 0))));
      const page = document.documentElement;
      page.dataset.down = charts[0].filter(([x, y]) => y > 5 && Math.abs(x) < 0.1 * y).length;
      page.dataset.shafts = charts[0].length;
      const before = charts.at(-3);
      page.dataset.common = Math.sign(charts[0].reduce((sum, [x, y], i) => sum + x * before[i][0] + y * before[i][1], 0));
      )";

int number(const Visit& visited, const char* name) { return std::stoi(visited.found.at(name)); }

void expect_marks(const Visit& visited, const std::map<std::string, int>& marks) {
  EXPECT_THAT(visited.marks, IsSupersetOf(marks));
}

TEST(Browser, PagesAreDrawnWhole) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const std::string grid =
      "chaintrue fit " CHAINTRUE_FIXTURES "/grids/seven_by_four.json -o map.json && ";
  const std::string sample = render_html(sample_document());
  const std::string diagnosis = page_of(sample_diagnosis());
  auto stable = sample_diagnosis();
  for (auto& removal : stable.stability->removals) removal.stands = true;
  const std::string map = made_by(grid + "chaintrue report map.json -o page.html", "page.html");
  const auto visits =
      visit_all({{sample, {}, kHoverAndOverlaps},
                 {sample, kPhone, phone_probe()},
                 {diagnosis},
                 {diagnosis, kLargePhone, phone_probe()},
                 {page_of(stable), {1200, 800}, kFoldedProbe},
                 {page_of(diagnosis_with_laws())},
                 {page_of(quiet_diagnosis())},
                 {page_of(diagnosis_of_holes())},
                 {map},
                 {as_printed(map), paper(), paper_probe()},
                 {as_printed(made_by(grid + "chaintrue report map.json --certificate -o page.html",
                                     "page.html")),
                  paper(), paper_probe()},
                 {as_printed(diagnosis_of_the_demo()), paper(), paper_probe()},
                 {map_of_a_tool_that_hangs_low(), {}, kShaftsProbe},
                 {diagnosis_of_a_worn_chain(), {}, kShaftsProbe}});
  for (std::size_t i = 0; i < visits.size(); ++i) EXPECT_THAT(visits[i].problems, IsEmpty()) << i;

  {
    SCOPED_TRACE("sample");
    // Before, after, and after at a larger magnification.
    expect_marks(visits[0], {{"bed_arrows point_marks", 3 * kSamplePoints},
                             {"bed_arrows shafts", 3 * kSamplePoints},
                             {"error_map cell_marks", kSampleCells},
                             {"error_map point_marks", kSamplePoints},
                             {"held_out_target hit_marks", kSamplePoints},
                             {"held_out_points point_marks", kSamplePoints},
                             {"error_steps bars", 4}});
    EXPECT_THAT(visits[0].found.at("tip"), StartsWith("block: point 1 "));
    EXPECT_EQ(visits[0].found.at("hidden"), "0: ");
    expect_fits_a_phone(visits[1]);
    EXPECT_EQ(visits[1].found.at("cut"), "0: ");
  }
  {
    SCOPED_TRACE("diagnosis");
    constexpr int kPoints = grid::testing::kSamplePoints;
    // The cause; before, after, and after at a larger magnification. Two chains, four panels each. Length,
    // folded and angle before and after for two chains; the visits once for each.
    expect_marks(visits[2], {{"bed_arrows point_marks", 4 * kPoints},
                             {"bed_arrows noise_ellipses", 4 * kPoints},
                             {"residual_strip point_marks", 8 * kPoints},
                             {"residual_scatter point_marks", 14 * kPoints},
                             {"probability_bars bars", 4},
                             {"gain_bars bars", 6},
                             {"next_points next_marks", 2},
                             {"next_points measured_marks", kPoints}});
    expect_fits_a_phone(visits[3]);
    // About three screens of 800; nothing folded, it was 11,700.
    EXPECT_LT(number(visits[4], "high"), 2500);
    EXPECT_GT(number(visits[4], "high"), 0);
    EXPECT_LT(number(visits[4], "highest"), 60);
    EXPECT_EQ(visits[4].found.at("fits"), "true");
    // Without the law, with it, and with it once more at a larger magnification.
    expect_marks(visits[5], {{"residual_scatter point_marks", 16 * kPoints},
                             {"bed_arrows point_marks", 7 * kPoints}});
    expect_marks(visits[6], {{"residual_scatter point_marks", 6 * kPoints}});
    // Before and after; measured, cause, rival and remainder; measured and three more.
    expect_marks(visits[7], {{"hole_distances distance_lines", 6 * kSampleDistances + 23},
                             {"residual_scatter point_marks", 4 * kSampleDistances}});
  }
  // 28 marks and six repeated visits.
  expect_marks(visits[8], {{"held_out_points point_marks", 34}});
  for (const std::size_t printed : {9U, 10U, 11U}) {
    EXPECT_EQ(visits[printed].found.at("tall"), "0: ") << printed;
    EXPECT_EQ(visits[printed].found.at("cut"), "0") << printed;
  }
  {
    SCOPED_TRACE("arrows");
    EXPECT_EQ(number(visits[12], "shafts"), 28);
    EXPECT_EQ(number(visits[12], "down"), 28) << "where it landed minus where it was sent";
    // The effect of the worn chain alone, and the measurements before naming it.
    EXPECT_EQ(number(visits[13], "common"), 1);
  }
}

TEST(Browser, FaultsOfAPageAreFound) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const std::string html = render_html(sample_document());
  MapPictures map = sample_pictures();
  map.error_map->cells.clear();
  map.points.clear();
  const auto visits =
      visit_all({{with(html, "\"type\":\"rule\"", "\"type\":\"ruler\"")},
                 {render_html(sample_document(map))},
                 {with(html, "\"from\":{\"data\":\"cells\"}", "\"from\":{\"data\":\"beyond\"}")},
                 {html, {}, "console.error('the needle');"},
                 {html}});
  EXPECT_THAT(visits[0].problems, Contains(HasSubstr("console: ")));
  EXPECT_THAT(visits[1].problems, Contains(HasSubstr("error_map is empty: ")));
  EXPECT_THAT(visits[2].problems, Contains(HasSubstr("error_map is empty: ")));
  EXPECT_THAT(visits[3].problems, Contains(HasSubstr("the needle")));
  EXPECT_THAT(visits[4].problems, IsEmpty());
}

// Folded sections are not printed; the sheets of start are one page each.
TEST(Browser, PagesAreShortOnPaper) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const int sheets = printed_sheets(diagnosis_of_the_demo());
  EXPECT_GE(sheets, 1);
  EXPECT_LE(sheets, 4);
  const std::string start =
      "chaintrue start " CHAINTRUE_FIXTURES "/good/groundcontrol_ring.ini shop";
  for (const char* page : {"shop/marks.html", "shop/holes.html"})
    EXPECT_EQ(printed_sheets(made_by(start, page)), 1) << page;
}

}  // namespace
}  // namespace chaintrue::report::testing
