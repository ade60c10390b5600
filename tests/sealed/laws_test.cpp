// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An excerpt of the sealed laws: sets whose outcome must stay. The rates are those of build/sealed_laws
/// (docs/diagnosis_rates.md).
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
    // Of the same rate as in the table: four in a thousand are further away.
    EXPECT_LT(trial.worst_sigmas.value_or(0.0), 3.0) << line_of("laws", trial);
  }
}

TEST(SealedLaws, FieldsCausesAndNothingAreNoLaw) {
  for (const std::string_view kind : {"gaussian", "matern", "uneven", "causes", "nothing"}) {
    for (const std::uint64_t seed : {3, 4}) {
      const LawsTrial trial = run_laws_trial(kind, seed);
      EXPECT_FALSE(trial.claimed) << line_of(kind, trial);
    }
  }
}

}  // namespace
}  // namespace chaintrue::sealed
