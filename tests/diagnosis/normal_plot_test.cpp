// SPDX-License-Identifier: GPL-3.0-or-later
// The test of normality of the residuals: its band, its scale, and residuals that are not normal.
#include "grid/diagnosis/normal_plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grid/synthetic/generator.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

ObservationSet session_of(std::uint64_t seed) {
  synthetic::SyntheticSpec spec;
  spec.repeats = 6;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
  spec.stated = StatedNoise{0.2, 0.3, 12.0};
  spec.seed = seed;
  return observations_of(synthetic::generate(model::Machine{}, spec).value().grid).value();
}

TEST(NormalPlot, HoldsItsListsInOrderAndTheMeanInsideTheBand) {
  const ObservationSet session = session_of(1);
  const auto a = analyse(session, {});
  ASSERT_TRUE(a);
  const auto plot = normal_plot(*a);
  ASSERT_TRUE(plot);
  EXPECT_EQ(plot->values.size(), 2 * session.units.size());
  EXPECT_TRUE(std::is_sorted(plot->values.begin(), plot->values.end()));
  EXPECT_TRUE(std::is_sorted(plot->expected.begin(), plot->expected.end()));
  double square = 0.0;
  for (std::size_t i = 0; i < plot->values.size(); ++i) {
    EXPECT_LT(plot->low[i], plot->expected[i]);
    EXPECT_GT(plot->high[i], plot->expected[i]);
    square += plot->values[i] * plot->values[i];
  }
  EXPECT_NEAR(square / static_cast<double>(plot->values.size()), 1.0, 1e-12);
}

// The shape is independent of the size of the noise.
TEST(NormalPlot, IsTheSameForNoiseOfAnySize) {
  const ObservationSet session = session_of(2);
  auto a = analyse(session, {});
  ASSERT_TRUE(a);
  const auto one = normal_plot(*a);
  a->estimate.left *= 4.0;  // a power of two: no rounding
  a->estimate.left_given_discrepancy *= 4.0;
  const auto other = normal_plot(*a);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->values, other->values);
  EXPECT_EQ(one->p_value, other->p_value);
}

TEST(NormalPlot, WhatIsNoNoiseLeavesTheBand) {
  const ObservationSet session = session_of(3);
  auto a = analyse(session, {});
  ASSERT_TRUE(a);
  // Many small ones and a few large ones.
  for (Eigen::VectorXd* left : {&a->estimate.left, &a->estimate.left_given_discrepancy}) {
    *left = left->array().cube().matrix();
  }
  const auto plot = normal_plot(*a);
  ASSERT_TRUE(plot);
  EXPECT_LT(plot->p_value, 0.01);
  bool outside = false;
  for (std::size_t i = 0; i < plot->values.size(); ++i) {
    outside = outside || plot->values[i] < plot->low[i] || plot->values[i] > plot->high[i];
  }
  EXPECT_TRUE(outside);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
