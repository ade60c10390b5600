// SPDX-License-Identifier: GPL-3.0-or-later
// Several sets of one machine in one fit, and an unknown tape zero offset.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grid/map/joint_fit.hpp"
#include "grid/synthetic/random.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid {
namespace {

using testing::HasSubstr;
using testing_support::nine_holes;
using testing_support::usual_holes;

TEST(UnknownHook, EachFileHasOneOfItsOwn) {
  MeasuredHoles first = synthetic::simulate_holes(nine_holes(), usual_holes(8))->set;
  first.tape.hook_sigma_mm = 5.0;
  MeasuredHoles second = first;
  for (HoleDistance& distance : second.distances) distance.distance_mm += 3.0;
  const auto fit = joint_fit({{"first", first}, {"second", second}});
  ASSERT_TRUE(fit) << fit.error().sentence;
  // The same readings except for the tape zero offset: a part of 3 mm^2 x sigma^2 / 5 mm^2 goes to
  // neither.
  EXPECT_NEAR(fit->distances[1].hook->mm - fit->distances[0].hook->mm, 3.0, 0.05);
}

TEST(JointFit, TwoSetsTellMoreThanEither) {
  const auto first = synthetic::simulate_holes(nine_holes(), usual_holes(8));
  const auto second = synthetic::simulate_holes(nine_holes(), usual_holes(9), first->truth);
  const auto sigma_of_fit = [](const Measured& sets) {
    const auto fit = joint_fit(sets);
    return tool_sigma_mm(*sets.machine(), fit->estimate.knowledge.covariance) /
           fit->estimate.noise_factor;
  };
  EXPECT_LT(sigma_of_fit({{"first", first->set}, {"second", second->set}}),
            std::min(sigma_of_fit(first->set), sigma_of_fit(second->set)));
}

TEST(UnknownHook, WhatIsAddedToEveryReadingIsTheHooks) {
  auto made = synthetic::simulate_holes(nine_holes(), usual_holes(12));
  made->set.tape.hook_sigma_mm = 1000.0;
  const auto before = joint_fit(made->set);
  for (HoleDistance& distance : made->set.distances) distance.distance_mm += 3.0;
  const auto after = joint_fit(made->set);
  ASSERT_TRUE(before && after);
  ASSERT_TRUE(before->distances.front().hook);
  // An offset known to a metre is practically unknown: a millionth of the shift remains.
  EXPECT_NEAR(after->distances.front().hook->mm - before->distances.front().hook->mm, 3.0, 1e-3);
  for (std::size_t k = 0; k < before->distances.front().distances.size(); ++k) {
    EXPECT_NEAR(after->distances.front().distances[k].left_out_mm, before->distances.front().distances[k].left_out_mm, 1e-3)
        << "the passes settle to 1e-3 sigmas";
  }
}

TEST(UnknownHook, ItsIntervalsCoverAsTheySay) {
  constexpr int kSets = 300;
  constexpr double kHookSigmaMm = 0.8;
  synthetic::Random random(21);
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    auto made = synthetic::simulate_holes(nine_holes(), usual_holes(seed));
    const double hook_mm = kHookSigmaMm * random.normal();
    for (HoleDistance& distance : made->set.distances) distance.distance_mm += hook_mm;
    made->set.tape.hook_sigma_mm = kHookSigmaMm;
    const auto fit = joint_fit(made->set);
    ASSERT_TRUE(fit) << "seed " << seed;
    covered += std::abs(fit->distances.front().hook->mm - hook_mm) < 1.96 * fit->distances.front().hook->sigma_mm;
  }
  // 95 % of 300, three standard deviations of so many draws either way.
  EXPECT_NEAR(covered / static_cast<double>(kSets), 0.95, 0.04);
}

TEST(UnknownHook, OneThatIsOffIsSpokenOf) {
  auto made = synthetic::simulate_holes(nine_holes(), usual_holes(14));
  for (HoleDistance& distance : made->set.distances) distance.distance_mm += 4.0;
  made->set.tape.hook_sigma_mm = 2.0;
  const auto fit = joint_fit(made->set);
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->map.contents().notes, testing::Contains(HasSubstr("Every tape distance reads")));
}

// A hook, or a bit's width, in every distance, and nobody stated it: the map was up to 2.5 mm off.
TEST(TapeZero, OneThatNobodyStatedIsTakenOffAndSaid) {
  for (const double zero_mm : {5.0, 6.35, -5.0}) {
    for (const std::uint64_t seed : {3, 4, 5}) {
      auto made = synthetic::simulate_holes(nine_holes(), usual_holes(seed));
      const auto sound = joint_fit(made->set);
      for (HoleDistance& distance : made->set.distances) distance.distance_mm += zero_mm;
      const auto fit = joint_fit(made->set);
      ASSERT_TRUE(sound && fit) << zero_mm;
      const FoundHook& found = *fit->distances.front().hook;
      // What the prior of 3 mm leaves to the machine: the share of its variance that is not learnt.
      const double left = std::pow(found.sigma_mm / 3.0, 2);
      EXPECT_LT(left, 0.1) << "twenty distances tell it";
      EXPECT_NEAR(found.mm - sound->distances.front().hook->mm, (1.0 - left) * zero_mm, 0.02 * std::abs(zero_mm));
      EXPECT_THAT(fit->map.contents().notes,
                  testing::Contains(testing::AllOf(
                      HasSubstr("Every tape distance reads"),
                      HasSubstr(zero_mm > 0.0 ? "is the hook or the bit's width in it?"
                                              : "between the near edges of the holes"))))
          << zero_mm << ", seed " << seed;
    }
  }
}

TEST(TapeZero, SoundFilesDoNotSpeakOfOne) {
  int spoken = 0;
  constexpr int kSets = 60;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    const auto fit = joint_fit(synthetic::simulate_holes(nine_holes(), usual_holes(seed))->set);
    ASSERT_TRUE(fit) << "seed " << seed;
    for (const std::string& note : fit->map.contents().notes)
      spoken += note.starts_with("Every tape distance") ? 1 : 0;
  }
  // One of 370 by chance: three of sixty have a chance of one in a thousand.
  EXPECT_LT(spoken, 3);
}

}  // namespace
}  // namespace chaintrue::grid
