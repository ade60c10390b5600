// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An excerpt of the sealed laws: sets with a fixed outcome. The rates are those of
/// build/sealed_laws (docs/diagnosis_rates.md).
#include <gtest/gtest.h>

#include "sealed/judge/laws_trial.hpp"

namespace chaintrue::sealed {
namespace {

// A step, a slope, an oblique slope, ripples and a drop, by the seeds of the command's first sets.
TEST(SealedLaws, AreClaimedAndRight) {
  for (const std::uint64_t seed : {1, 4, 6, 12, 15, 18, 20, 24, 27}) {
    const LawsTrial trial = run_laws_trial("laws", seed);
    EXPECT_TRUE(trial.claimed) << line_of("laws", trial);
    EXPECT_TRUE(trial.leads) << line_of("laws", trial);
    // For the same rate as in the table: four in a thousand are further away.
    EXPECT_LT(trial.worst_sigmas.value_or(0.0), 3.0) << line_of("laws", trial);
  }
}

// In belts a slope, ripples and a step; in holes a step, ripples of a chain's length and of its angle.
TEST(SealedLaws, AreClaimedAndRightInBeltsAndHoles) {
  const std::pair<std::string_view, std::vector<std::uint64_t>> kinds[] = {{"belts_laws", {4, 5, 11, 13}},
                                                                           {"holes_laws", {1, 5, 6, 9}}};
  for (const auto& [kind, seeds] : kinds) {
    for (const std::uint64_t seed : seeds) {
      const LawsTrial trial = run_laws_trial(kind, seed);
      EXPECT_TRUE(trial.claimed) << line_of(kind, trial);
      EXPECT_TRUE(trial.leads) << line_of(kind, trial);
      EXPECT_LT(trial.worst_sigmas.value_or(0.0), 3.0) << line_of(kind, trial);
      // A wave predicts left-out readings better than models without a law, even outside the
      // measured part; all distances of a hole are left out, or the others would determine its
      // position. A step differs from a smooth pattern only at its two neighbours.
      ASSERT_FALSE(trial.laws.empty());
      if (!is_periodic(trial.laws.front().shape)) continue;
      const auto& held_out = trial.laws.front().held_out;
      ASSERT_TRUE(held_out) << line_of(kind, trial);
      EXPECT_LT(held_out->inside.with_mm, held_out->inside.without_mm) << line_of(kind, trial);
      EXPECT_LT(held_out->outside.with_mm, held_out->outside.without_mm) << line_of(kind, trial);
    }
  }
}

TEST(SealedLaws, AreNotClaimedForFieldsCausesOrNoise) {
  for (const std::string_view kind : {"gaussian", "matern", "uneven", "causes", "nothing", "belts_gaussian",
                                      "belts_causes", "belts_nothing", "holes_gaussian", "holes_nothing"}) {
    for (const std::uint64_t seed : {3, 4}) {
      const LawsTrial trial = run_laws_trial(kind, seed);
      EXPECT_FALSE(trial.claimed) << line_of(kind, trial);
    }
  }
}

}  // namespace
}  // namespace chaintrue::sealed
