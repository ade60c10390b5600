// SPDX-License-Identifier: GPL-3.0-or-later
// Several sets of one machine as one, and a hook whose offset is not known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grid/synthetic/random.hpp"
#include "tests/holes/hole_sets.hpp"
#include "tests/holes/sets_together.hpp"

namespace chaintrue::grid {
namespace {

using testing::HasSubstr;
using testing_support::classic;
using testing_support::nine_holes;
using testing_support::usual_holes;

/// The same commands under a firmware whose settings are somewhat off.
MeasuredHoles with_firmware(double spacing_off_mm) {
  MeasuredHoles set = nine_holes();
  set.machine->controller.kind = model::ControllerKind::maslow_classic;
  set.machine->controller.settings.motor_spacing_mm =
      set.machine->motors.right.x_mm - set.machine->motors.left.x_mm + spacing_off_mm;
  return set;
}

TEST(SetsTogether, HolesAreWhereTheirOwnControllerPutThem) {
  // Both sets cut without noise by one true machine: the readings of either follow from the truth.
  std::vector<MeasuredHoles> sets;
  model::Machine truth;
  for (const double off_mm : {0.0, 9.0}) {
    MeasuredHoles design = with_firmware(off_mm);
    design.hole_sigma_mm = 0.0;
    design.tape = {1e-9, 25.0};
    auto made = synthetic::simulate_holes(design, usual_holes(3));
    ASSERT_TRUE(made);
    truth = made->truth;
    sets.push_back(made->set);
  }
  const auto all = sets_together(sets);
  ASSERT_TRUE(all) << all.error();
  EXPECT_EQ(all->holes.size(), 18u);
  EXPECT_EQ(all->distances.size(), 40u);
  EXPECT_EQ(all->holes[9].name, "A (2)");
  EXPECT_EQ(all->tape.hook_offset_mm, 0.0) << "taken off each reading";
  EXPECT_EQ(all->distances[20].session, 1u);
  const auto distances = observation::TapeDistances::in_given_order(*all);
  ASSERT_TRUE(distances);
  const auto predicted = distances->predicted({model::ReadingModel(truth), {}});
  ASSERT_TRUE(predicted);
  // Commands to 1e-9 mm, poses to 1e-9 mm, the tape's own 1e-9 mm.
  EXPECT_LT((distances->measured() - *predicted).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(SetsTogether, ASetByItselfStaysWhatItIs) {
  const auto made = synthetic::simulate_holes(nine_holes(), usual_holes(6));
  const auto one = sets_together({made->set});
  ASSERT_TRUE(one);
  const auto before = fit_holes(made->set);
  const auto after = fit_holes(*one);
  for (std::size_t k = 0; k < before->distances.size(); ++k) {
    EXPECT_DOUBLE_EQ(after->distances[k].left_out_mm, before->distances[k].left_out_mm);
    EXPECT_DOUBLE_EQ(after->distances[k].commanded_mm, before->distances[k].commanded_mm);
  }
}

TEST(SetsTogether, TwoSetsTellMoreThanEither) {
  const auto first = synthetic::simulate_holes(nine_holes(), usual_holes(8));
  const auto second = synthetic::simulate_holes(nine_holes(), usual_holes(9), first->truth);
  const auto all = sets_together({first->set, second->set});
  const auto sigma_of_fit = [](const MeasuredHoles& set) {
    const auto fit = fit_holes(set);
    return tool_sigma_mm(*set.machine, fit->estimate.knowledge.covariance) / fit->estimate.noise_factor;
  };
  EXPECT_LT(sigma_of_fit(*all), std::min(sigma_of_fit(first->set), sigma_of_fit(second->set)));
}

TEST(SetsTogether, OnlyTheFirstSheetsEdgesCount) {
  const MeasuredHoles with_edges = plan_holes(classic(), {.holes = 9, .edges = true})->set;
  const auto all = sets_together({with_edges, with_edges});
  ASSERT_TRUE(all);
  std::size_t edges = 0;
  for (const HoleDistance& distance : with_edges.distances) edges += distance.edge ? 1 : 0;
  EXPECT_EQ(all->distances.size(), 2 * with_edges.distances.size() - edges);
}

TEST(SetsTogether, AnotherMachineOrHoleSigmaIsRefusedInWords) {
  MeasuredHoles other = nine_holes();
  other.machine->motors.left.x_mm -= 5.0;
  EXPECT_THAT(sets_together({nine_holes(), other}).error(),
              testing::AllOf(HasSubstr("set 2"), HasSubstr("motor_left_x_mm is")));
  other = nine_holes();
  other.hole_sigma_mm = 0.7;
  EXPECT_THAT(sets_together({nine_holes(), other}).error(), HasSubstr("hole_sigma_mm is 0.7"));
  other = nine_holes();
  other.machine.reset();
  EXPECT_THAT(sets_together({nine_holes(), other}).error(), HasSubstr("no machine"));
  EXPECT_THROW((void)sets_together({}), std::invalid_argument);
}

TEST(UnknownHook, WhatIsAddedToEveryReadingIsTheHooks) {
  auto made = synthetic::simulate_holes(nine_holes(), usual_holes(12));
  made->set.tape.hook_sigma_mm = 1000.0;
  const auto before = fit_holes(made->set);
  for (HoleDistance& distance : made->set.distances) distance.distance_mm += 3.0;
  const auto after = fit_holes(made->set);
  ASSERT_TRUE(before && after);
  ASSERT_EQ(before->hooks.size(), 1u);
  // A hook known to a metre is as good as unknown: a millionth of the shift stays.
  EXPECT_NEAR(after->hooks[0].mm - before->hooks[0].mm, 3.0, 1e-3);
  for (std::size_t k = 0; k < before->distances.size(); ++k) {
    EXPECT_NEAR(after->distances[k].left_out_mm, before->distances[k].left_out_mm, 1e-3)
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
    const auto fit = fit_holes(made->set);
    ASSERT_TRUE(fit) << "seed " << seed;
    covered += std::abs(fit->hooks[0].mm - hook_mm) < 1.96 * fit->hooks[0].sigma_mm;
  }
  // 95 % of 300, three standard deviations of so many draws either way.
  EXPECT_NEAR(covered / static_cast<double>(kSets), 0.95, 0.04);
}

TEST(UnknownHook, OneThatIsOffIsSpokenOf) {
  auto made = synthetic::simulate_holes(nine_holes(), usual_holes(14));
  for (HoleDistance& distance : made->set.distances) distance.distance_mm += 4.0;
  made->set.tape.hook_sigma_mm = 2.0;
  const auto fit = fit_holes(made->set);
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->notes, testing::Contains(testing::AllOf(HasSubstr("mm too long, all alike"))));
}

}  // namespace
}  // namespace chaintrue::grid
