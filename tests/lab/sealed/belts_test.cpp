// SPDX-License-Identifier: GPL-3.0-or-later
// Hidden sessions of four belts: the proposed measurements where several causes remain, and the
// report on them. Rates of names are tested by the excerpt in rates_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "sealed/judge/belts_trial.hpp"

namespace chaintrue::sealed {
namespace {

using testing::ElementsAre;

// Outcomes are frozen by their seeds: a rate of a few dozen sets hides a change.
TEST(SealedBelts, WhatIsProposedPartsCausesThatAreLeftOpen) {
  std::vector<std::uint64_t> proposed, parted;
  for (std::uint64_t seed = 1101; seed < 1113; ++seed) {
    const BeltsTrial trial =
        run_belts_trial({.effect = "", .least_strength = 6.0, .most_strength = 9.0}, seed, true);
    if (trial.proposed > 0) proposed.push_back(seed);
    if (trial.parted) parted.push_back(seed);
  }
  EXPECT_THAT(proposed,
              ElementsAre(1101, 1102, 1104, 1107, 1108));
  EXPECT_THAT(parted, ElementsAre(1102, 1104, 1107, 1108));
}

TEST(SealedBelts, APatternThatIsTheAnswerHasASize) {
  // Here a name was withdrawn, and the pattern in its place must have a size and a length.
  const BeltsTrial trial =
      run_belts_trial({.effect = "", .least_strength = 6.0, .most_strength = 8.0}, 2004);
  EXPECT_NE(trial.sentence.find("changes smoothly from place to place"), std::string::npos)
      << trial.sentence;
  EXPECT_EQ(trial.sentence.find("over some 0 mm"), std::string::npos) << trial.sentence;
}

}  // namespace
}  // namespace chaintrue::sealed
