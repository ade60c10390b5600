// SPDX-License-Identifier: GPL-3.0-or-later
// A test drawing through the common analysis: settings that are off, a bad measure, a cause that no
// settings make, and the file.
#include <gmock/gmock.h>

#include <algorithm>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/drawing_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/plotter/drawing_fit.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid::diagnosis::drawing_tests {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Measures of the page that a plotter with this effect draws.
TestDrawing drawn_with(const model::PlotterMachine& set,
                       const std::vector<model::AppliedEffect>& hidden, std::uint64_t seed) {
  TestDrawing drawing = planned_drawing({set, model::PlotterFirmware::fluidnc});
  const auto plotter = model::make_plotter_mechanism(set)->with_effects(hidden);
  const observation::DrawnMeasures crosses = drawn_measures_of(drawing).value();
  std::vector<Eigen::Vector2d> pens;
  for (const auto& cross : crosses.points()) {
    const auto pen = plotter->locate_by_first(cross.paid_out).value();
    pens.emplace_back(pen.x_mm, pen.y_mm);
  }
  Random random(seed, 43);
  for (auto& m : drawing.measures) {
    m.value_mm =
        observation::measure_row(m.kind, pens[m.from], pens[m.to], pens[m.middle]).value_mm +
        kRulerSigmaMm * random.normal();
  }
  return drawing;
}

TEST(DrawingDiagnosis, TreatsABadZeroAsASetting) {
  const std::string path = std::string(CHAINTRUE_FIXTURES) + "/plotter/mural_drawing.json";
  const auto found = diagnose(files::parse_drawing(files::read_whole_file(path), "drawing.json"));
  ASSERT_TRUE(found) << found.error().sentence();
  EXPECT_EQ(found->verdict, Verdict::nothing_found);
  EXPECT_THAT(found->sentence, HasSubstr("Settings are off, and nothing else is wrong: zero left"));
  ASSERT_TRUE(found->drawing);
  const auto zero =
      std::find_if(found->drawing->settings.begin(), found->drawing->settings.end(),
                   [](const DrawnSetting& own) { return own.name == "zero_left_mm"; });
  ASSERT_NE(zero, found->drawing->settings.end());
  // The fixture was drawn with zeros 23 mm off; three of its sigmas of 2 mm.
  EXPECT_NEAR(zero->found, 23.0, 6.0);
  EXPECT_TRUE(zero->off);
}

TEST(DrawingDiagnosis, ACauseThatNoSettingsMakeIsNamedWithItsSize) {
  const auto found =
      diagnose(drawn_with(model::mural(1500.0), {{"servo_arm", "", {{"offset_mm", 10.0}}}}, 5));
  ASSERT_TRUE(found) << found.error().sentence();
  ASSERT_THAT(found->causes, SizeIs(1));
  EXPECT_EQ(found->causes.front().cause.effect->id, "servo_arm");
  const ParameterEstimate& size = found->causes.front().parameters.front();
  // Four of its own sigmas, seed 5.
  EXPECT_NEAR(size.value, 10.0, 4.0 * size.sigma);
  EXPECT_THAT(found->sentence, HasSubstr("mm to the right"));
}

TEST(DrawingDiagnosis, RejectsABadMeasureByName) {
  TestDrawing drawing = drawn_with(model::mural(1500.0), {}, 6);
  drawing.measures[3].value_mm += 10.0;
  const auto found = diagnose(drawing);
  ASSERT_TRUE(found) << found.error().sentence();
  EXPECT_THAT(found->causes, IsEmpty()) << "seed 6";
  ASSERT_THAT(found->outliers, SizeIs(1));
  EXPECT_EQ(found->outliers.front().of, Observations::drawing);
  EXPECT_EQ(found->outliers.front().index, 3U);
  EXPECT_TRUE(found->drawing->measures[3].rejected);
  EXPECT_THAT(found->sentence, HasSubstr(words_of(drawing, 3)));
}

TEST(DrawingDiagnosis, RefusesTheSlipsThatTheFitRefuses) {
  TestDrawing drawing = drawn_with(model::mural(1500.0), {}, 7);
  for (auto& m : drawing.measures) m.value_mm /= 25.4;
  const auto found = diagnose(drawing);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().sentence(), fit_drawing(drawing).error().sentence());
}

/// Drift, skips and shifts have chains' names: read again they are the cords'.
TEST(DrawingDiagnosis, ItsFileIsReadAsItWasWritten) {
  const auto found = diagnose(
      drawn_with(model::mural(1500.0), {{"pen_off_centre", "", {{"offset_mm", 12.0}}}}, 8));
  ASSERT_TRUE(found) << found.error().sentence();
  const std::string text = files::write_diagnosis(*found, std::nullopt);
  const Diagnosis again = files::parse_diagnosis(text, "d.json");
  EXPECT_EQ(files::write_diagnosis(again, std::nullopt), text);
  ASSERT_EQ(again.not_testable.size(), found->not_testable.size());
  for (std::size_t i = 0; i < again.not_testable.size(); ++i)
    EXPECT_EQ(again.not_testable[i].cause, found->not_testable[i].cause) << i;
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis::drawing_tests
