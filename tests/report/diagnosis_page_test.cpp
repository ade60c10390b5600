// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The page of a diagnosis, made by the command from a file, in a real browser.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "model/reading_model.hpp"
#include "tests/support/files.hpp"
#include "tests/support/process.hpp"
#include "tests/support/sample_diagnosis.hpp"
#include "tests/holes/hole_sets.hpp"
#include "tests/report/browser.hpp"

namespace chaintrue::report::testing {
namespace {

using grid::diagnosis::Diagnosis;
using grid::testing::kSamplePoints;
using grid::testing::quiet_diagnosis;
using grid::testing::sample_diagnosis;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class DiagnosisPage : public ::testing::Test {
 protected:
  [[nodiscard]] std::string page_of(const Diagnosis& found) const {
    std::ofstream(folder_ / "diagnosis.json") << grid::files::write_diagnosis(found);
    const testing_support::Outcome ran =
        testing_support::run_line(folder_.path(), "chaintrue report diagnosis.json -o page.html");
    EXPECT_EQ(ran.code, 0) << ran.err;
    return testing_support::read_text(folder_ / "page.html");
  }

 private:
  testing_support::TemporaryFolder folder_;
};

// The visible part before scrolling, with the mandatory line.
TEST_F(DiagnosisPage, BeginsWithTheAnswer) {
  const Diagnosis found = sample_diagnosis();
  const std::string html = page_of(found);
  const std::string first = html.substr(0, html.find("<section>"));
  EXPECT_THAT(first, HasSubstr(found.sentence));
  for (const std::string& line : found.what_to_do) EXPECT_THAT(first, HasSubstr(line));
  EXPECT_THAT(first, HasSubstr("What this does not prove: " + found.not_proved));
  for (const char* question : {"Found?", "Named?", "Enough data?", "Corrected?"})
    EXPECT_THAT(first, HasSubstr(fmt::format("<b>{}</b>", question)));
  EXPECT_THAT(first, HasSubstr("0.94 to 0.31 mm, noise 0.29"));
  EXPECT_THAT(first, HasSubstr("<b>4.8 mm</b><span>error of the tool today, "));
}

TEST_F(DiagnosisPage, HoldsTheNumbersOfTheFile) {
  const std::string html = page_of(sample_diagnosis());
  for (const char* text :
       {" error, left: ",
        ", order of visits assumed)",
        "can tell it from tape scale, both: ",
        "uncorrected, at these points",
        "uncorrected, sheet placed",
        "3.42 to 4.38",
        "named 7 of 8 times",
        "Error of the tool on &quot;a day later&quot;, 60 points not used here, mm",
        "the points bear no order",
        "point 10",
        "(63.5 mm)",
        "seed 18446744073709551615",
        "0.2 mm a chain and 0.3 mm a ",
        ", 12 degrees of freedom)"}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
}

TEST_F(DiagnosisPage, DrawsEveryChartAndLogsNothing) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const Visit visited = visit(page_of(sample_diagnosis()));
  EXPECT_THAT(problems_of(visited), IsEmpty());
  // The cause; before, after, and after at a larger magnification.
  EXPECT_EQ(count_marks(visited, "bed_arrows", "point_marks"), 4 * kSamplePoints);
  EXPECT_EQ(count_marks(visited, "bed_arrows", "noise_ellipses"), 4 * kSamplePoints);
  // Two chains, four panels each.
  EXPECT_EQ(count_marks(visited, "residual_strip", "point_marks"), 8 * kSamplePoints);
  // Length, folded and angle before and after for two chains; the visits once for each.
  EXPECT_EQ(count_marks(visited, "residual_scatter", "point_marks"), 14 * kSamplePoints);
  EXPECT_EQ(count_marks(visited, "probability_bars", "bars"), 4);
  EXPECT_EQ(count_marks(visited, "gain_bars", "bars"), 6);
  EXPECT_EQ(count_marks(visited, "separation_matrix", "cell_marks"), 6);
  EXPECT_EQ(count_marks(visited, "name_support", "point_marks"), kSamplePoints);
  EXPECT_EQ(count_marks(visited, "normal_plot", "quantile_marks"), 3);
  EXPECT_EQ(count_marks(visited, "next_points", "next_marks"), 2);
  EXPECT_EQ(count_marks(visited, "next_points", "measured_marks"), kSamplePoints);
}

// The likeliest law and its best rival, each among the points' partial residuals, and the bed with and without it.
TEST_F(DiagnosisPage, DrawsLawsAmongTheirPoints) {
  using grid::diagnosis::Enters;
  using grid::diagnosis::Law;
  using grid::diagnosis::LawOf;
  using grid::diagnosis::LawShape;
  Diagnosis found = sample_diagnosis();
  Law wave;
  wave.of = LawOf::length_left;
  wave.shape = LawShape::wave;
  wave.enters = Enters::left;
  wave.probability = 0.95;
  wave.shape_probability = 0.9;
  wave.from = 0.0;
  wave.to = 4000.0;
  wave.parameters = {{"size_mm", 0.4, 0.05}, {"period_mm", 63.5, 0.3}, {"phase_rad", 0.2, 0.1}};
  for (const auto& point : found.points) {
    wave.points.push_back({point.index, point.lengths.left_mm, 0.1, 0.05, -0.05});
  }
  Law step = wave;
  step.of = LawOf::x;
  step.shape = LawShape::step;
  step.probability = 0.04;
  step.from = -1200.0;
  step.to = 1200.0;
  step.parameters = {{"size_mm", 0.3, 0.1}, {"place_mm", 100.0, 50.0}};
  for (std::size_t k = 0; k < step.points.size(); ++k) step.points[k].at = found.points[k].mark.x_mm;
  if (!found.unexplained) found.unexplained.emplace();
  found.unexplained->laws = {wave, step};
  const std::string html = page_of(found);
  // Sixty waves over the bed are drawn as one.
  EXPECT_THAT(html, HasSubstr("the left chain's length, mm past a full period of 63.5"));
  EXPECT_THAT(html, HasSubstr("Its best rival"));
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const Visit visited = visit(html);
  EXPECT_THAT(problems_of(visited), IsEmpty());
  EXPECT_EQ(count_marks(visited, "residual_scatter", "point_marks"), 16 * kSamplePoints);
  // Without the law, with it, and with it once more at a larger magnification.
  EXPECT_EQ(count_marks(visited, "bed_arrows", "point_marks"), 7 * kSamplePoints);
}

// A name that depends on one point shows where without opening anything; sections without problems
// are folded, and their charts have the right width once opened.
TEST_F(DiagnosisPage, FoldsAwayWhatIsAsItShouldBe) {
  const std::string html = page_of(sample_diagnosis());
  EXPECT_THAT(html, HasSubstr("<h2>Does the name hang on a few points?</h2>\n<div"));
  EXPECT_THAT(html, HasSubstr("<summary><h2>Is what is left only noise?</h2></summary>"));
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const Visit visited = visit(html, R"(
    const folded = document.querySelector('[data-spec="normal_plot"]');
    folded.closest("details").open = true;
    // A loaded machine may be slow to draw anew: looked at until it fits, or time is up.
    (function look() {
      const svg = folded.querySelector("svg").getBoundingClientRect();
      const fits = svg.width > 0 && Math.abs(svg.width - folded.clientWidth) < 3;
      if (!fits) return setTimeout(look, 20);
      document.documentElement.dataset.fits = true;
    })();)");
  EXPECT_THAT(problems_of(visited), IsEmpty());
  EXPECT_THAT(visited.dom, HasSubstr("data-fits=\"true\""));
}

// Where the cause puts the tool is what the tested model says: with the shift the machine with the
// cause has the lengths that the machine without it has at the mark.
TEST_F(DiagnosisPage, DrawsWhereEachCauseAlonePutsTheTool) {
  const Diagnosis found = sample_diagnosis();
  const std::string html = page_of(found);
  const std::size_t begin = html.find("id=\"data\">") + 10;
  const auto charts =
      nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin)).at("charts");
  const auto picture = std::find_if(charts.begin(), charts.end(), [](const auto& chart) {
    return chart.at("spec") == "bed_arrows";
  });
  ASSERT_NE(picture, charts.end());
  const auto& arrows = picture->at("data").at("arrows");
  ASSERT_EQ(arrows.size(), found.points.size());
  model::Machine without = found.extended_machine;
  without.effects.clear();
  const model::ReadingModel plain(without), worn(found.extended_machine);
  for (const auto& arrow : arrows) {
    const double x = arrow.at("x_mm"), y = arrow.at("y_mm");
    const model::BedPoint there{x + arrow.at("dx_mm").get<double>(),
                                y + arrow.at("dy_mm").get<double>()};
    // The shift is of first order: of some 3 mm the second is within 0.02 mm.
    constexpr double kSecondOrderMm = 0.02;
    const auto sent = plain.at({x, y}).value().lengths;
    const auto reached = worn.at(there).value().lengths;
    EXPECT_NEAR(reached.left_mm, sent.left_mm, kSecondOrderMm);
    EXPECT_NEAR(reached.right_mm, sent.right_mm, kSecondOrderMm);
  }
  EXPECT_THAT(html, HasSubstr("drawn "));
}

// A file may hold what no session has; the answer is shown all the same.
TEST_F(DiagnosisPage, HasNoPictureOfACauseWhereTwoVisitsHaveOneNumber) {
  Diagnosis found = sample_diagnosis();
  found.points[1].order = found.points[0].order;
  const std::string html = page_of(found);
  EXPECT_THAT(html, HasSubstr("<h2>Cause</h2>"));
  EXPECT_THAT(html, Not(HasSubstr("Where this alone puts the tool")));
}

// Verdict, causes and what to do; the rest is a click away.
TEST_F(DiagnosisPage, IsShortUntilItIsUnfolded) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  Diagnosis found = sample_diagnosis();
  for (auto& removal : found.stability->removals) removal.stands = true;
  // What is folded is a line each.
  constexpr std::string_view kHeight = R"(
      const folded = [...document.querySelectorAll("section.folded")];
      const lines = folded.map((section) => section.getBoundingClientRect().height);
      document.documentElement.dataset.highest = Math.round(Math.max(0, ...lines));
      document.documentElement.dataset.high =
          Math.round(document.documentElement.scrollHeight - lines.reduce((sum, line) => sum + line, 0));
      )";
  const Visit visited = visit(page_of(found), kHeight, {1200, 800});
  const std::size_t at = visited.dom.find("data-high=\"");
  ASSERT_NE(at, std::string::npos);
  // About three screens of 800; nothing folded, it was 11,700.
  EXPECT_LT(std::stoi(visited.dom.substr(at + 11)), 2500);
  const std::size_t line = visited.dom.find("data-highest=\"");
  ASSERT_NE(line, std::string::npos);
  EXPECT_LT(std::stoi(visited.dom.substr(line + 14)), 60);
}

TEST_F(DiagnosisPage, OfNothingFoundHasNoEmptyCharts) {
  const std::string html = page_of(quiet_diagnosis());
  EXPECT_THAT(html, HasSubstr("The points do not say in which order they were visited"));
  EXPECT_THAT(html, Not(HasSubstr("Why this cause")));
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const Visit visited = visit(html);
  EXPECT_THAT(problems_of(visited), IsEmpty());
  EXPECT_EQ(count_marks(visited, "residual_scatter", "point_marks"), 6 * kSamplePoints);
}

TEST_F(DiagnosisPage, OfHolesDrawsDistances) {
  grid::synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.seed = 4;
  spec.hidden = {{"chain_pitch_error", "left", {{"elongation", 0.0015}}}};
  auto made = grid::synthetic::simulate_holes(testing_support::nine_holes(), spec);
  made->set.distances[3].distance_mm += 15.0;
  Diagnosis found = *grid::diagnosis::diagnose(made->set);
  found.grid_name = "nine holes";
  grid::diagnosis::NextMeasurement hole;
  hole.kind = grid::diagnosis::MeasurementKind::distance;
  hole.words = "a new hole at (0, -500), measured to A, C";
  hole.mark = model::MarkPoint{0.0, -500.0};
  hole.to = {"A", "C"};
  grid::diagnosis::NextMeasurement pair;
  pair.kind = grid::diagnosis::MeasurementKind::distance;
  pair.words = "the distance A-G";
  pair.from = "A";
  pair.to = {"G"};
  found.next_measurements = {hole, pair};
  ASSERT_EQ(found.outliers.size(), 1u);
  const std::string html = page_of(found);
  for (const char* text : {"What it does to the distances",
                           "What these distances can tell apart",
                           "Bad distances",
                           "named 8 of 9 times",
                           "A new hole at (0, -500), measured to A, C."})
    EXPECT_THAT(html, HasSubstr(text));
  EXPECT_THAT(html, Not(HasSubstr("Over one sprocket turn")));
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  const Visit visited = visit(html);
  EXPECT_THAT(problems_of(visited), IsEmpty());
  constexpr int kDistances = 20;
  // Before and after; measured, cause, rival and remainder; measured and three more.
  EXPECT_EQ(count_marks(visited, "hole_distances", "distance_lines"), 6 * kDistances + 23);
  EXPECT_EQ(count_marks(visited, "residual_scatter", "point_marks"), 4 * kDistances);
}

TEST_F(DiagnosisPage, NothingStandsOutOfAPhoneScreenAndNoLabelIsCutOff) {
  if (!has_browser()) GTEST_SKIP() << "Chromium was not found when the tests were configured";
  std::string probe(kCutLabels);
  probe += kOverlappingLegends;
  probe +=
      "document.documentElement.dataset.overflow = "
      "document.documentElement.scrollWidth - document.documentElement.clientWidth;";
  const Visit visited = visit(page_of(sample_diagnosis()), probe, {390, 844});
  EXPECT_THAT(problems_of(visited), IsEmpty());
  EXPECT_THAT(visited.dom, HasSubstr("data-overflow=\"0\""));
  EXPECT_THAT(visited.dom, HasSubstr("data-cut-labels=\"0: \""));
  EXPECT_THAT(visited.dom, HasSubstr("data-overlaps=\"0: \""));
}

}  // namespace
}  // namespace chaintrue::report::testing
