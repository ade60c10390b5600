// SPDX-License-Identifier: GPL-3.0-or-later
/// The page of a diagnosis, made by the command from a file; that of the sample is read in
/// tests/cli/cases/diagnosis_files.cases, and how it is drawn in browser_test.cpp.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "model/reading_model.hpp"
#include "tests/report/made_pages.hpp"
#include "tests/support/sample_diagnosis.hpp"

namespace chaintrue::report::testing {
namespace {

using grid::diagnosis::Diagnosis;
using grid::testing::quiet_diagnosis;
using grid::testing::sample_diagnosis;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(DiagnosisPage, HasNoReasonsWithoutAFinding) {
  EXPECT_THAT(page_of(quiet_diagnosis()), Not(HasSubstr("Why this cause")));
}

// Sixty waves over the bed are drawn as one.
TEST(DiagnosisPage, FoldsALawIntoOnePeriod) {
  EXPECT_THAT(page_of(diagnosis_with_laws()), HasSubstr("full period of 63.5"));
}

TEST(DiagnosisPage, ShowsDistancesOfHoles) {
  const Diagnosis found = diagnosis_of_holes();
  EXPECT_EQ(found.outliers.size(), 1U);
  const std::string html = page_of(found);
  for (const char* text : {"8 of 9 times", "(0, -500), measured to A, C."})
    EXPECT_THAT(html, HasSubstr(text));
  EXPECT_THAT(html, Not(HasSubstr("Over one sprocket turn")));
}

// The cause's shift agrees with the model: at the shifted position the machine with the cause has
// the lengths that the machine without it has at the mark.
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
    // The shift is first order: for some 3 mm the second-order term is below 0.02 mm.
    constexpr double kSecondOrderMm = 0.02;
    const auto sent = plain.at({x, y}).value().lengths;
    const auto reached = worn.at(there).value().lengths;
    EXPECT_NEAR(reached.left_mm, sent.left_mm, kSecondOrderMm);
    EXPECT_NEAR(reached.right_mm, sent.right_mm, kSecondOrderMm);
  }
  EXPECT_THAT(html, HasSubstr("drawn "));
}

}  // namespace
}  // namespace chaintrue::report::testing
