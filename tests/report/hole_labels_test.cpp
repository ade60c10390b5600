// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Labels of holes: over random layouts each is nearer to its own hole
/// than to any other, and lies on nothing.
#include "tools/report/hole_labels.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random.hpp"

namespace chaintrue::report::testing {
namespace {

constexpr double kLeft = 30.0, kWide = 900.0;

DrawnHole drawn(double x, double y, std::size_t number) {
  return {x, y, std::string(1, static_cast<char>('A' + number)),
          fmt::format("({:.0f}, {:.0f})", -x - 1000.0, -y - 1000.0)};
}

void expect_readable(const std::vector<DrawnHole>& holes) {
  const std::vector<HoleLabel> labels = place_labels(holes, kLeft, kLeft + kWide);
  ASSERT_EQ(labels.size(), holes.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double own = distance_to(labels[i], holes[i].x, holes[i].y);
    for (std::size_t k = 0; k < holes.size(); ++k) {
      if (k == i) continue;
      EXPECT_LT(own, distance_to(labels[i], holes[k].x, holes[k].y))
          << "the label of " << holes[i].name << " stands at " << holes[k].name;
      const bool apart = labels[i].right <= labels[k].left || labels[k].right <= labels[i].left ||
                         labels[i].bottom <= labels[k].top || labels[k].bottom <= labels[i].top;
      EXPECT_TRUE(apart) << "the labels of " << holes[i].name << " and " << holes[k].name;
    }
    EXPECT_GE(labels[i].left, kLeft);
    EXPECT_LE(labels[i].right, kLeft + kWide);
  }
}

// Holes that a plan puts together are 150 mm apart and more: 55 units of a sheet of 2.4 m.
TEST(HoleLabels, AreUnambiguousForRandomHoles) {
  constexpr double kApart = 55.0, kHigh = 450.0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    testing_support::Random random(seed);
    std::vector<DrawnHole> holes;
    for (int tries = 0; tries < 400 && holes.size() < 20; ++tries) {
      const double x = kLeft + 0.5 * kWide * (1.0 + std::tanh(random.normal()));
      const double y = 60.0 + 0.5 * kHigh * (1.0 + std::tanh(random.normal()));
      const bool fits = std::all_of(holes.begin(), holes.end(), [&](const DrawnHole& other) {
        return std::hypot(other.x - x, other.y - y) >= kApart;
      });
      if (fits) holes.push_back(drawn(x, y, holes.size()));
    }
    ASSERT_GE(holes.size(), 10U);
    expect_readable(holes);
  }
}

TEST(HoleLabels, AreOmittedIfAmbiguous) {
  const std::vector<DrawnHole> holes = {drawn(300, 200, 0), drawn(340, 200, 1), drawn(380, 200, 2)};
  const auto labels = place_labels(holes, kLeft, kLeft + kWide);
  EXPECT_TRUE(std::any_of(labels.begin(), labels.end(),
                          [](const HoleLabel& label) { return !label.has_place; }));
  expect_readable(holes);
}

TEST(HoleLabels, DistanceIsFromTheNearestPointOfTheLabel) {
  const HoleLabel label{10, 30, 5, 15};
  EXPECT_EQ(distance_to(label, 20, 10), 0.0);
  EXPECT_EQ(distance_to(label, 33, 19), 5.0);
}

}  // namespace
}  // namespace chaintrue::report::testing
