// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoses of simulated sessions of four belts with a cause: its name, belt and size, bad readings
// by point and belt, no name where there is no cause, and causes that belts cannot show.
#include "grid/diagnosis/diagnose.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/whole_file.hpp"
#include "model/belts/belt_effects.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Verdict;
using model::Belt;
using testing::HasSubstr;

constexpr double kPulledNoiseMm = 0.3;

MeasuredBelts measured_in(std::vector<model::AppliedEffect> hidden, std::uint64_t seed = 1,
                          double noise_mm = kPulledNoiseMm) {
  // Wide and high: the usual sizes of all causes are then detectable.
  return testing_support::belts_session({.width_share = 0.7,
                                         .height_share = 0.6,
                                         .noise_mm = noise_mm,
                                         .hidden = std::move(hidden),
                                         .seed = seed});
}

Diagnosis diagnosed(const MeasuredBelts& belts) { return diagnosis::diagnose(belts).value(); }

class HiddenCause : public testing::TestWithParam<model::AppliedEffect> {};

// Three times the usual size for weakly observable causes, so that each is far beyond the noise; an
// anchor is moved perpendicularly to the belt in the middle: along it a move looks like a skip of teeth.
INSTANTIATE_TEST_SUITE_P(
    Every, HiddenCause,
    testing::Values(
        model::AppliedEffect{"belt_stretch", "", {{"elongation", 0.004}}},
        model::AppliedEffect{"belt_scale", "tl", {{"scale", 0.003}}},
        model::AppliedEffect{"belt_scale", "br", {{"scale", -0.003}}},
        model::AppliedEffect{"anchor_height", "tr", {{"offset_mm", 60.0}}},
        model::AppliedEffect{"anchor_moved",
                             "bl",
                             {{"distance_mm", 7.0}, {"direction_rad", 2.1}, {"first_visit", 37.0}}},
        model::AppliedEffect{"tooth_skip", "br", {{"teeth", 1.0}, {"first_visit", 37.0}}},
        model::AppliedEffect{"zero_shift", "tr", {{"shift_mm", 3.0}, {"first_visit", 37.0}}},
        model::AppliedEffect{"drift", "tl", {{"rate_mm_per_visit", 0.06}}},
        model::AppliedEffect{"belt_zero", "all", {{"offset_mm", -25.0}}}),
    [](const auto& tested) { return tested.param.effect + tested.param.side; });

TEST_P(HiddenCause, IsNamedWithItsBeltAndItsSize) {
  const model::AppliedEffect& hidden = GetParam();
  SCOPED_TRACE("seed 1");
  const Diagnosis found = diagnosed(measured_in({hidden}));
  ASSERT_EQ(found.verdict, Verdict::named) << found.sentence;
  const auto& cause = found.causes.front();
  EXPECT_EQ(cause.cause.effect->id, hidden.effect);
  EXPECT_EQ(name(cause.cause.side), hidden.side);
  const auto& size = cause.parameters[0];
  // Four sigmas: one seed in 16 000; a whole number of teeth is exact.
  EXPECT_NEAR(size.value, hidden.parameters.at(size.parameter), std::max(4.0 * size.sigma, 1e-9));
  EXPECT_LT(found.belts->residual_sigma_mm, found.belts->spread_before_mm);
  ASSERT_TRUE(found.belts->prediction && found.belts->prediction_before);
  EXPECT_LT(found.belts->prediction->rms_mm, found.belts->prediction_before->rms_mm);
}

TEST(BeltsDiagnosis, NamesNothingOnASoundMachine) {
  const Diagnosis found = diagnosed(measured_in({}));
  EXPECT_TRUE(found.causes.empty()) << "seed 1: " << found.sentence;
}

TEST(BeltsDiagnosis, NamesABadReadingByPointAndBelt) {
  for (const bool stretched : {false, true}) {
    std::vector<model::AppliedEffect> hidden;
    if (stretched) hidden = {{"belt_stretch", "", {{"elongation", 0.004}}}};
    MeasuredBelts belts = measured_in(hidden);
    belts.points[17].lengths_mm.tr += 80.0;
    const Diagnosis found = diagnosed(belts);
    ASSERT_EQ(found.outliers.size(), 1U) << found.sentence;
    EXPECT_EQ(found.outliers[0].index, 17U);
    EXPECT_EQ(found.outliers[0].belt, Belt::tr);
    EXPECT_FALSE(found.outliers[0].or_belt);
    // The position of a bad reading is known to about its noise.
    EXPECT_NEAR(found.outliers[0].residual_mm, 80.0, 5.0 * kPulledNoiseMm);
    EXPECT_EQ(found.causes.size(), stretched ? 1U : 0U) << found.sentence;
    EXPECT_THAT(found.sentence + found.what_to_do.back() + found.what_to_do.front() +
                    (found.what_to_do.size() > 1 ? found.what_to_do[1] : ""),
                // Files count from 0, messages from 1.
                HasSubstr("the top right belt at point 18"));
  }
}

TEST(BeltsDiagnosis, CannotTellWhichBeltIsBadBetweenTwoAnchors) {
  MeasuredBelts belts = measured_in({});
  // The middle of the 9 x 9 points is on the line from the top right to the bottom left anchor.
  belts.points[40].lengths_mm.tl += 20.0;
  const Diagnosis found = diagnosed(belts);
  ASSERT_EQ(found.outliers.size(), 1U) << found.sentence;
  const auto& bad = found.outliers[0];
  EXPECT_EQ(bad.index, 40U);
  ASSERT_TRUE(bad.belt && bad.or_belt) << found.sentence;
  EXPECT_EQ((std::set<Belt>{*bad.belt, *bad.or_belt}), (std::set<Belt>{Belt::tl, Belt::br}));
  EXPECT_THAT(found.sentence, HasSubstr("at point 41, or the "));
}

TEST(BeltsDiagnosis, RejectsAPlaceWithSeveralBadReadings) {
  MeasuredBelts belts = measured_in({});
  // No other position makes one belt of a side longer and the other shorter.
  belts.points[40].lengths_mm.tr += 40.0;
  belts.points[40].lengths_mm.tl -= 40.0;
  const Diagnosis found = diagnosed(belts);
  ASSERT_EQ(found.outliers.size(), 1U);
  EXPECT_EQ(found.outliers[0].index, 40U);
  EXPECT_FALSE(found.outliers[0].belt);
}

TEST(BeltsDiagnosis, ReportsLengthsThatExcludeTheArms) {
  MeasuredBelts belts = measured_in({{"belt_zero", "all", {{"offset_mm", -153.4}}}});
  const Diagnosis found = diagnosed(belts);
  ASSERT_FALSE(found.causes.empty()) << found.sentence;
  EXPECT_THAT(found.what_to_do.front(), HasSubstr("do not include arm and extension"));
}

TEST(BeltsDiagnosis, UntestableCausesNameTheMeasurementThatTestsThem) {
  MeasuredBelts belts = measured_in({});
  for (auto& point : belts.points) point.order.reset();
  const Diagnosis found = diagnosed(belts);
  const auto reason = [&](std::string_view id, std::string_view side) -> std::string {
    for (const auto& one : found.not_testable) {
      if (one.cause.effect->id == id && name(one.cause.side) == side) return one.reason;
    }
    return "";
  };
  EXPECT_THAT(reason("belt_scale", "all"), HasSubstr("tape one long distance"));
  EXPECT_THAT(reason("tooth_skip", "bl"), HasSubstr("add order"));
  EXPECT_THAT(reason("anchor_moved", "all"), HasSubstr("from two edges of the sheet"));
}

TEST(BeltsDiagnosis, TheFileHoldsTheWholeDiagnosis) {
  const Diagnosis found = diagnosed(measured_in({{"drift", "tl", {{"rate_mm_per_visit", 0.06}}}}));
  const std::string text = files::write_diagnosis(found);
  EXPECT_THAT(text, HasSubstr("\"observations\": \"belts\""));
  const Diagnosis again = files::parse_diagnosis(text, "belts.json");
  EXPECT_EQ(files::write_diagnosis(again), text);
  // Chains have drift too: the side decides which.
  EXPECT_EQ(again.causes.front().cause, found.causes.front().cause);
}

// A skip near the noise: a likely cause is not also reported absent, and no places are proposed
// that achieve almost nothing.
TEST(BeltsDiagnosis, DoesNotCallAPossibleCauseAbsent) {
  int likely = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Diagnosis found = diagnosed(
        measured_in({{"tooth_skip", "tl", {{"teeth", 1.0}, {"first_visit", 40.0}}}}, seed, 1.2));
    for (const auto& hypothesis : found.hypotheses) {
      if (hypothesis.effect != "tooth_skip" || hypothesis.probability < 0.05) continue;
      ++likely;
      for (const auto& bound : found.bounds) {
        EXPECT_FALSE(bound.cause.effect->id == "tooth_skip" &&
                     name(bound.cause.side) == hypothesis.side)
            << hypothesis.side << " " << hypothesis.probability;
      }
      if (found.causes.empty() && hypothesis.probability >= 0.2) {
        EXPECT_THAT(found.sentence, HasSubstr("No cause is certain"));
      }
    }
    double reached = 1.0;
    for (const auto& next : found.next_measurements) {
      if (next.kind != diagnosis::MeasurementKind::distance) reached = next.raises_probability_to;
    }
    EXPECT_GE(reached, 0.25) << "eight places for less are eight for nothing";
  }
  EXPECT_GT(likely, 0) << "no set in which a skip was likely: nothing was tested";
}

TEST(BeltsDiagnosis, FailsWithTheMessageOfTheFit) {
  MeasuredBelts belts = measured_in({});
  belts.points.resize(4);
  const auto found = diagnosis::diagnose(belts);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().sentence(), HasSubstr("too few"));
}

// With the causes only this uncertainty remains of the tool's error.
TEST(BeltsDiagnosis, ErrorsOfTheToolIncludeTheirUncertainty) {
  const auto read =
      files::read(files::parse_belts, CHAINTRUE_FIXTURES "/belts/lower_belts_short.json");
  const Diagnosis found = diagnosed(read.belts);
  EXPECT_GT(found.belts->tool.after_mm, 0.0);
  EXPECT_GE(found.belts->tool.before_mm, found.belts->tool.after_mm);
  EXPECT_GE(found.belts->tool.stated_mm, found.belts->tool.after_mm);
}

TEST(BeltsDiagnosis, MarksAPlaceProposedTwice) {
  const auto read =
      files::read(files::parse_belts, CHAINTRUE_FIXTURES "/belts/lower_belts_short.json");
  std::set<std::pair<double, double>> proposed;
  int repeated = 0;
  for (const diagnosis::NextMeasurement& next : diagnosed(read.belts).next_measurements) {
    if (next.kind != diagnosis::MeasurementKind::point) continue;
    const bool is_first = proposed.emplace(next.mark->x_mm, next.mark->y_mm).second;
    EXPECT_THAT(next.words, HasSubstr(is_first ? "a further place" : "the same place again"));
    repeated += is_first ? 0 : 1;
  }
  EXPECT_GT(repeated, 0);
}

}  // namespace
}  // namespace chaintrue::grid
