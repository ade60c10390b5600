// SPDX-License-Identifier: GPL-3.0-or-later
// Anchors fitted once, and positions measured later. That each verdict is the right one is a law of
// every mechanism: tests/contracts/mechanism_check_test.cpp.
#include "grid/belts/anchors_check.hpp"

#include <gmock/gmock.h>

#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid {
namespace {

using model::Belt;
using testing::HasSubstr;

constexpr double kNoiseMm = 0.5;

MeasuredBelts measured(int columns, int rows, std::uint64_t seed) {
  return testing_support::belts_session({.columns = columns,
                                         .rows = rows,
                                         .width_share = 0.6,
                                         .height_share = 0.5,
                                         .noise_mm = kNoiseMm,
                                         .seed = seed});
}

TEST(AnchorsCheck, NamesABeltWithAShiftedZeroAndItsSize) {
  const auto fit = fit_belts(measured(6, 6, 1));
  MeasuredBelts shifted = measured(3, 2, 501);
  for (BeltPoint& point : shifted.points) point.lengths_mm.br += 6.0;
  const Check check = check_anchors(*fit, shifted).value();
  EXPECT_EQ(check.hypotheses.front().what, model::Change::zero) << "seeds 1 and 501";
  EXPECT_EQ(check.hypotheses.front().side, "br");
  // Six places that each leave br about half of its noise, and the anchors' uncertainty.
  EXPECT_NEAR(check.hypotheses.front().size(), 6.0, 4.0 * kNoiseMm);
  EXPECT_THAT(check.sentence, HasSubstr("retracting and extending the belts again"));
}

TEST(AnchorsCheck, RefusesUncheckableAnchorsWithASentence) {
  const auto fit = fit_belts(measured(6, 6, 1));
  MeasuredBelts inches = measured(3, 2, 2);
  for (BeltPoint& point : inches.points) {
    for (const Belt belt : model::kBelts) point.lengths_mm[belt] /= 25.4;
  }
  const auto nowhere = check_anchors(*fit, inches);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().reason, CheckFailure::Reason::nowhere);
  BeltsFit of_holes = *fit;
  of_holes.checks = 0;
  EXPECT_EQ(check_anchors(of_holes, inches).error().reason, CheckFailure::Reason::no_noise);
}

}  // namespace
}  // namespace chaintrue::grid
