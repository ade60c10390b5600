// SPDX-License-Identifier: GPL-3.0-or-later
// Hidden sessions of four belts, few enough for every test run; build/sealed_belts poses
// hundreds, and its table stands in docs/maslow4.md.
#include <gtest/gtest.h>

#include <iostream>

#include "sealed/judge/belts_trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::BeltRecipe;

constexpr int kBeltSets = 12;

template <class Right>
int right_of(const BeltRecipe& recipe, std::uint64_t first_seed, Right right) {
  int good = 0;
  for (int k = 0; k < kBeltSets; ++k) {
    const BeltsTrial trial = run_belts_trial(recipe, first_seed + static_cast<std::uint64_t>(k));
    if (right(trial)) {
      ++good;
    } else {
      testing::Test::RecordProperty("wrong", static_cast<int>(trial.seed));
      std::cout << "seed " << trial.seed << ", " << trial.secret.effect << " " << trial.secret.side
                << ": " << trial.sentence << "\n";
    }
  }
  return good;
}

TEST(SealedBelts, AStrongCauseIsNamedAlone) {
  // 27 of 28 are (docs/maslow4.md): two of twelve are wrong by chance in 6 of 100 such runs.
  EXPECT_GE(right_of({.effect = "", .least_strength = 12.0, .most_strength = 40.0},
                     901,
                     [](const BeltsTrial& t) { return t.exact; }),
            kBeltSets - 1);
}

TEST(SealedBelts, WhereNothingIsHiddenNothingIsNamed) {
  // A name where noise does as much once in a thousand sessions: one of twelve is wrong in 1 run of 80.
  EXPECT_GE(
      right_of({.effect = "", .nothing = true}, 951, [](const BeltsTrial& t) { return !t.named; }),
      kBeltSets);
}

TEST(SealedBelts, WhatIsProposedPartsCausesThatAreLeftOpen) {
  constexpr int kDraws = 24;
  int proposed = 0;
  int parted = 0;
  for (std::uint64_t seed = 1101; seed < 1101 + kDraws; ++seed) {
    const BeltsTrial trial =
        run_belts_trial({.effect = "", .least_strength = 6.0, .most_strength = 9.0}, seed, true);
    proposed += trial.proposed > 0;
    parted += trial.parted;
    if (trial.proposed > 0 && !trial.parted) {
      std::cout << "seed " << seed << ", " << trial.secret.effect << " " << trial.secret.side
                << ": " << trial.sentence << "\n";
    }
  }
  ASSERT_GT(proposed, 5) << "seeds 1101 to " << 1100 + kDraws << " leave nothing open";
  // 34 of 51 are parted (docs/maslow4.md): fewer than a third of nine are so in 1 run of 120.
  EXPECT_GE(3 * parted, proposed) << "of seeds 1101 to " << 1100 + kDraws;
}

TEST(SealedBelts, APatternThatIsTheAnswerHasASize) {
  // A name was taken back here, and the pattern in its place had neither size nor length.
  const BeltsTrial trial =
      run_belts_trial({.effect = "", .least_strength = 6.0, .most_strength = 8.0}, 2004);
  EXPECT_NE(trial.sentence.find("changes smoothly from place to place"), std::string::npos)
      << trial.sentence;
  EXPECT_EQ(trial.sentence.find("over some 0 mm"), std::string::npos) << trial.sentence;
}

TEST(SealedBelts, BadReadingsAreFoundByPointAndBelt) {
  EXPECT_GE(right_of({.effect = "", .nothing = true, .bad_readings = 3},
                     1001,
                     [](const BeltsTrial& t) { return t.bad_found; }),
            kBeltSets - 1);
}

}  // namespace
}  // namespace chaintrue::sealed
