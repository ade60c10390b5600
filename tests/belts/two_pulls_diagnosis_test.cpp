// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions with two pulls of the belts: their simulation, and that causes that yield with the pull
// are distinguished from others.
#include <gtest/gtest.h>

#include "grid/diagnosis/diagnose.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid::two_pulls_diagnosed {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Verdict;

/// Pull of the second pass over the first.
constexpr double kHarder = 1.6;

MeasuredBelts measured(std::vector<model::AppliedEffect> hidden, std::vector<double> pulls,
                       double noise_mm = 0.5) {
  return testing_support::belts_session({.columns = 7,
                                         .rows = 6,
                                         .noise_mm = noise_mm,
                                         .pulls = std::move(pulls),
                                         .hidden = std::move(hidden),
                                         .seed = 3});
}

TEST(TwoPulls, APassHasItsPullAndVisitsAreNumberedOn) {
  const MeasuredBelts belts =
      measured({{"belt_stretch", "", {{"elongation", 0.004}}}}, {1.0, kHarder}, 0.0);
  ASSERT_EQ(belts.points.size(), 84U);
  EXPECT_EQ(different_pulls(belts), (std::vector<double>{1.0, kHarder}));
  for (std::size_t k = 0; k < 42; ++k) {
    const BeltPoint& first = belts.points[k];
    const BeltPoint& second = belts.points[k + 42];
    EXPECT_EQ(*second.order, static_cast<int>(k) + 42);
    // A holding belt carries more too: 0.6 of 0.4 % times its own tension, less the weight's part.
    EXPECT_LT(second.lengths_mm.tl, first.lengths_mm.tl);
    EXPECT_LT(second.lengths_mm.tr, first.lengths_mm.tr);
    // Level spans of belts with arm and heights: 0.6 of 0.4 % of the belt, to a twentieth.
    const double shorter = first.lengths_mm.bl - second.lengths_mm.bl;
    const double belt_mm = first.lengths_mm.bl - 153.4;
    EXPECT_NEAR(shorter, 0.6 * 0.004 * belt_mm, 0.05 * 0.6 * 0.004 * belt_mm);
  }
}

TEST(TwoPulls, ResolveWhatOnePullLeavesOpen) {
  // Weak enough that other anchors, a belt's scale or the stretch do nearly the same.
  const std::vector<model::AppliedEffect> flex = {{"anchor_flex", "", {{"give_mm", 2.0}}}};
  const Diagnosis one = diagnosis::diagnose(measured(flex, {})).value();
  EXPECT_NE(one.verdict, Verdict::named) << one.sentence;
  const Diagnosis two = diagnosis::diagnose(measured(flex, {1.0, kHarder})).value();
  ASSERT_EQ(two.verdict, Verdict::named) << two.sentence;
  EXPECT_EQ(two.causes.front().cause.effect->id, "anchor_flex") << two.sentence;
  // Sizes are reported at the least pull, to three of their sigmas.
  EXPECT_NEAR(two.causes.front().parameters.front().value, 2.0,
              3.0 * two.causes.front().parameters.front().sigma);
}

TEST(TwoPulls, ProposesNoThirdPass) {
  const Diagnosis two =
      diagnosis::diagnose(measured({{"anchor_flex", "", {{"give_mm", 0.2}}}}, {1.0, kHarder}))
          .value();
  EXPECT_FALSE(two.belts->second_pass);
}

}  // namespace
}  // namespace chaintrue::grid::two_pulls_diagnosed
