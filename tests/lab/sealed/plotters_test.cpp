// SPDX-License-Identifier: GPL-3.0-or-later
// Causes hidden in drawings that a second implementation hung.
#include <gtest/gtest.h>

#include <map>

#include "sealed/judge/binomial.hpp"
#include "sealed/judge/plotter_sets.hpp"

namespace chaintrue::sealed::plotters_tests {
namespace {

/// Both tests fail by chance once in a thousand runs.
constexpr double kRare = 1e-3;

// 230 sets: fails in 93 of 100 runs where 80 % are right.
TEST(SealedPlotters, NameNinetyPercentOfStrongCauses) {
  constexpr std::uint64_t kSeeds = 10;
  int sets = 0, right = 0;
  for (const PlotterKind kind : kPlotterKinds) {
    for (const HiddenCause& cause : causes_of(kind)) {
      for (std::uint64_t seed = 1001; seed <= 1000 + kSeeds; ++seed) {
        const PlotterOutcome outcome = outcome_of(plotter_set(kind, cause, 8.0, 16.0, seed));
        ++sets;
        right += outcome == PlotterOutcome::named || outcome == PlotterOutcome::in_set ? 1 : 0;
      }
    }
  }
  EXPECT_GT(probability_of_at_least(sets - right, sets, 0.10), kRare)
      << right << " of " << sets << ", seeds 1001 to " << 1000 + kSeeds;
}

// 300 sets a kind: fails in 93 of 100 runs where 5 % are named.
TEST(SealedPlotters, NameNothingInNinetyNinePercentOfSoundOnes) {
  constexpr int kSets = 300;
  for (const PlotterKind kind : kPlotterKinds) {
    int named = 0;
    for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
      const PlotterOutcome outcome = outcome_of(plotter_set(kind, {}, 0.0, 0.0, seed));
      named += outcome == PlotterOutcome::nothing ? 0 : 1;
    }
    EXPECT_GT(probability_of_at_least(named, kSets, 0.01), kRare)
        << name(kind) << ": " << named << " of " << kSets << ", seeds 1 to " << kSets;
  }
}

}  // namespace
}  // namespace chaintrue::sealed::plotters_tests
