// SPDX-License-Identifier: GPL-3.0-or-later
/// The page of a diagnosis, made by the command from a file; how it is drawn is tested in browser_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "model/reading_model.hpp"
#include "tests/support/sample_diagnosis.hpp"
#include "tests/report/made_pages.hpp"

namespace chaintrue::report::testing {
namespace {

using grid::diagnosis::Diagnosis;
using grid::testing::quiet_diagnosis;
using grid::testing::sample_diagnosis;
using ::testing::HasSubstr;
using ::testing::Not;

// The visible part before scrolling, with the mandatory line.
TEST(DiagnosisPage, BeginsWithTheAnswer) {
  const Diagnosis found = sample_diagnosis();
  const std::string html = page_of(found);
  const std::string first = html.substr(0, html.find("<section>"));
  EXPECT_THAT(first, HasSubstr(found.sentence));
  for (const std::string& line : found.what_to_do) EXPECT_THAT(first, HasSubstr(line));
  EXPECT_THAT(first, HasSubstr(found.not_proved));
  EXPECT_THAT(first, HasSubstr("0.94 to 0.31 mm, noise 0.29"));
  EXPECT_THAT(first, HasSubstr("<b>4.8 mm</b>"));
}

TEST(DiagnosisPage, HoldsTheNumbersOfTheFile) {
  const std::string html = page_of(sample_diagnosis());
  for (const char* text : {"3.42 to 4.38",
                           "7 of 8 times",
                           "&quot;a day later&quot;, 60 points",
                           "point 10",
                           "(63.5 mm)",
                           "seed 18446744073709551615",
                           "0.2 mm a chain and 0.3 mm a ",
                           ", 12 degrees of freedom)"})
    EXPECT_THAT(html, HasSubstr(text));
}

// A name that depends on one point shows where without opening anything; sections without problems are
// folded.
TEST(DiagnosisPage, FoldsAwayWhatIsAsItShouldBe) {
  const std::string html = page_of(sample_diagnosis());
  EXPECT_THAT(html, HasSubstr("<h2>Does the name hang on a few points?</h2>\n<div"));
  EXPECT_THAT(html, HasSubstr("<summary><h2>What the error follows</h2></summary>"));
  EXPECT_THAT(page_of(quiet_diagnosis()), Not(HasSubstr("Why this cause")));
}

// Sixty waves over the bed are drawn as one.
TEST(DiagnosisPage, FoldsALawIntoOnePeriod) {
  EXPECT_THAT(page_of(diagnosis_with_laws()), HasSubstr("full period of 63.5"));
}

TEST(DiagnosisPage, OfHolesTellsOfDistances) {
  const Diagnosis found = diagnosis_of_holes();
  EXPECT_EQ(found.outliers.size(), 1U);
  const std::string html = page_of(found);
  for (const char* text : {"8 of 9 times", "(0, -500), measured to A, C."}) EXPECT_THAT(html, HasSubstr(text));
  EXPECT_THAT(html, Not(HasSubstr("Over one sprocket turn")));
}

// Where the cause puts the tool is what the tested model says: with the shift the machine with the
// cause has the lengths that the machine without it has at the mark.
TEST(DiagnosisPage, DrawsWhereEachCauseAlonePutsTheTool) {
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
TEST(DiagnosisPage, HasNoPictureOfACauseWhereTwoVisitsHaveOneNumber) {
  Diagnosis found = sample_diagnosis();
  found.points[1].order = found.points[0].order;
  const std::string html = page_of(found);
  EXPECT_THAT(html, HasSubstr("<h2>Cause</h2>"));
  EXPECT_THAT(html, Not(HasSubstr("Where this alone puts the tool")));
}

}  // namespace
}  // namespace chaintrue::report::testing
