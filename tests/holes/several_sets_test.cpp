// SPDX-License-Identifier: GPL-3.0-or-later
// Several sets of one machine in one fit, and an unknown tape zero offset.
#include <gmock/gmock.h>

#include <cmath>

#include "grid/estimation/observation_set.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/synthetic/generator.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid {
namespace {

using testing::HasSubstr;
using testing_support::cut_holes;
using testing_support::nine_holes;
using testing_support::usual_holes;

TEST(UnknownTapeZero, EachFileHasItsOffset) {
  MeasuredHoles first = cut_holes(8).set;
  first.tape.tape_zero_offset_sigma_mm = 5.0;
  MeasuredHoles second = first;
  for (HoleDistance& distance : second.distances) distance.distance_mm += 3.0;
  const auto fit = joint_fit({{"first", first}, {"second", second}});
  ASSERT_TRUE(fit) << fit.error().sentence();
  // The same readings except for the tape zero offset: a part of 3 mm^2 x sigma^2 / 5 mm^2 goes to
  // neither.
  EXPECT_NEAR(fit->distances[1].tape_zero->mm - fit->distances[0].tape_zero->mm, 3.0, 0.05);
}

TEST(JointFit, TwoSetsLowerTheError) {
  const auto first = cut_holes(8);
  const auto second = synthetic::simulate_holes(nine_holes(), usual_holes(9), first.truth);
  const auto sigma_of_fit = [](const Measured& sets) {
    const auto fit = joint_fit(sets);
    return tool_sigma_mm(*sets.machine(), fit->estimate.knowledge.covariance) /
           fit->estimate.noise_factor;
  };
  EXPECT_LT(sigma_of_fit({{"first", first.set}, {"second", second->set}}),
            std::min(sigma_of_fit(first.set), sigma_of_fit(second->set)));
}

/// A session of 28 marks on the machine that cuts the holes.
MeasuredGrid marks_of(std::uint64_t seed) {
  synthetic::SyntheticSpec spec;
  spec.noise = {.length_mm = 0.1, .position_mm = 0.3};
  spec.stated = StatedNoise{0.1, 0.3, 12.0};
  spec.seed = seed;
  return synthetic::generate(*nine_holes().machine, spec).value().grid;
}

MeasuredGrid with_zeros_more(MeasuredGrid grid, double left_mm, double right_mm) {
  for (MeasuredPoint& point : grid.points) {
    point.lengths->left_mm += left_mm;
    point.lengths->right_mm += right_mm;
  }
  return grid;
}

/// The share of a shift that goes to everything else, since the prior keeps it small.
double pulled_mm(const estimation::SessionZero& zero, double shift_mm) {
  return std::abs(shift_mm) * std::pow(zero.sigma_mm / estimation::kSessionZeroSigmaMm, 2);
}

TEST(SessionZeros, AnOffsetBelongsToItsSession) {
  const MeasuredGrid first = marks_of(1);
  const MeasuredGrid second = marks_of(2);
  const auto before = joint_fit({{"first", first}, {"second", second}});
  ASSERT_TRUE(before) << before.error().sentence();
  for (const double shift_mm : {5.0, -40.0}) {
    const auto after =
        joint_fit({{"first", first}, {"second", with_zeros_more(second, shift_mm, 0.0)}});
    ASSERT_TRUE(after) << after.error().sentence();
    EXPECT_FALSE(after->estimate.observations[0].zeros);
    ASSERT_TRUE(after->estimate.observations[1].zeros);
    const auto& found = *after->estimate.observations[1].zeros;
    const auto& none = *before->estimate.observations[1].zeros;
    const double pulled = 1.1 * pulled_mm(found[0], shift_mm);
    EXPECT_NEAR(found[0].mm - none[0].mm, shift_mm, pulled + 1e-3) << "passes converge to 1e-3";
    EXPECT_NEAR(found[1].mm, none[1].mm, pulled + 1e-3);
    for (const model::MarkPoint mark : {model::MarkPoint{0, 0}, model::MarkPoint{-900, 400}}) {
      const auto answer = after->map.query(mark);
      const auto usual = before->map.query(mark);
      ASSERT_TRUE(answer && usual);
      EXPECT_NEAR(answer->lengths.left_mm, usual->lengths.left_mm, pulled + 1e-3);
      EXPECT_NEAR(answer->lengths.right_mm, usual->lengths.right_mm, pulled + 1e-3);
    }
    EXPECT_THAT(after->map.contents().notes,
                testing::Contains(testing::AllOf(
                    HasSubstr("second: the chains' zeros differ from those in first: left chain"),
                    HasSubstr(shift_mm > 0.0 ? "mm more" : "mm less"),
                    HasSubstr("The map is for the zeros of first"))));
  }
  EXPECT_THAT(before->map.contents().notes, testing::Not(testing::Contains(HasSubstr("zeros"))));
}

TEST(SessionZeros, MapBelongsToTheFirstSession) {
  const MeasuredGrid now = marks_of(3);
  const MeasuredGrid other = with_zeros_more(marks_of(4), 0.0, 6.0);
  const auto map = joint_fit({{"now", now}, {"other", other}});
  const auto reversed = joint_fit({{"other", other}, {"now", now}});
  ASSERT_TRUE(map && reversed);
  const auto here = map->map.query({200.0, 100.0});
  const auto there = reversed->map.query({200.0, 100.0});
  ASSERT_TRUE(here && there);
  const double sigma_mm = (*map->estimate.observations[1].zeros)[1].sigma_mm;
  // The same readings: what differs is the zero that the lengths count from, and the prior's pull.
  EXPECT_NEAR(there->lengths.right_mm - here->lengths.right_mm, 6.0, 4.0 * sigma_mm);
}

TEST(SessionZeros, HolesShareTheMachinesZeros) {
  const MeasuredHoles set = cut_holes(6).set;
  const auto fit = joint_fit({{"holes", set}, {"grid", marks_of(5)}, {"more", marks_of(7)}});
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_FALSE(fit->estimate.observations[0].zeros);
  EXPECT_FALSE(fit->estimate.observations[1].zeros);
  EXPECT_TRUE(fit->estimate.observations[2].zeros);
}

TEST(UnknownTapeZero, AbsorbsAConstantAddedToEveryReading) {
  auto made = cut_holes(12);
  made.set.tape.tape_zero_offset_sigma_mm = 1000.0;
  const auto before = joint_fit(made.set);
  for (HoleDistance& distance : made.set.distances) distance.distance_mm += 3.0;
  const auto after = joint_fit(made.set);
  ASSERT_TRUE(before && after);
  ASSERT_TRUE(before->distances.front().tape_zero);
  // An offset known to a metre is practically unknown: a millionth of the shift remains.
  EXPECT_NEAR(after->distances.front().tape_zero->mm - before->distances.front().tape_zero->mm, 3.0,
              1e-3);
  for (std::size_t k = 0; k < before->distances.front().distances.size(); ++k) {
    EXPECT_NEAR(after->distances.front().distances[k].left_out_mm,
                before->distances.front().distances[k].left_out_mm, 1e-3)
        << "the passes settle to 1e-3 sigmas";
  }
}

TEST(UnknownTapeZero, IsReportedIfNonzero) {
  auto made = cut_holes(14);
  for (HoleDistance& distance : made.set.distances) distance.distance_mm += 4.0;
  made.set.tape.tape_zero_offset_sigma_mm = 2.0;
  const auto fit = joint_fit(made.set);
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->map.contents().notes, testing::Contains(HasSubstr("Every tape distance reads")));
}

// An unstated hook or bit width in every distance made the map wrong by up to 2.5 mm.
TEST(TapeZero, UnstatedIsRemovedAndReported) {
  for (const double zero_mm : {6.35, -5.0}) {
    SCOPED_TRACE(testing::Message() << zero_mm << " mm, seed 3");
    auto made = cut_holes(3);
    const auto sound = joint_fit(made.set);
    for (HoleDistance& distance : made.set.distances) distance.distance_mm += zero_mm;
    const auto fit = joint_fit(made.set);
    ASSERT_TRUE(sound && fit);
    EXPECT_THAT(sound->map.contents().notes,
                testing::Not(testing::Contains(HasSubstr("Every tape distance"))));
    const FoundTapeZero& found = *fit->distances.front().tape_zero;
    // What the prior of 3 mm leaves to the machine: the share of its variance that is not learnt.
    const double left = std::pow(found.sigma_mm / 3.0, 2);
    EXPECT_LT(left, 0.1) << "twenty distances tell it";
    EXPECT_NEAR(found.mm - sound->distances.front().tape_zero->mm, (1.0 - left) * zero_mm,
                0.02 * std::abs(zero_mm));
    EXPECT_THAT(fit->map.contents().notes,
                testing::Contains(testing::AllOf(
                    HasSubstr("Every tape distance reads"),
                    HasSubstr(zero_mm > 0.0 ? "does it include the hook or the bit's width?"
                                            : "between the near edges of the holes"))));
  }
}

}  // namespace
}  // namespace chaintrue::grid
