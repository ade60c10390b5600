// SPDX-License-Identifier: GPL-3.0-or-later
// The blocks are compact and equally large, and each point is in one of them.
#include "grid/estimation/spatial_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace chaintrue::grid {
namespace {

TEST(SpatialBlocks, SplitColumnsIntoALowerAndAnUpperHalf) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> across(-1000.0, 1000.0), up(-500.0, 500.0);
  std::vector<LengthPoint> points(80);
  for (LengthPoint& point : points) point.mark = {across(random), up(random)};
  const auto blocks = spatial_blocks(points);
  ASSERT_EQ(blocks.size(), 8U);
  std::set<std::size_t> seen;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    EXPECT_EQ(blocks[block].size(), 10U);
    EXPECT_TRUE(std::is_sorted(blocks[block].begin(), blocks[block].end()));
    seen.insert(blocks[block].begin(), blocks[block].end());
  }
  EXPECT_EQ(seen.size(), points.size());
  const auto range = [&](const std::vector<std::size_t>& block, double model::MarkPoint::*axis) {
    const auto [low, high] = std::minmax_element(block.begin(), block.end(), [&](auto a, auto b) {
      return points[a].mark.*axis < points[b].mark.*axis;
    });
    return std::pair(points[*low].mark.*axis, points[*high].mark.*axis);
  };
  for (std::size_t lower = 0; lower < blocks.size(); lower += 2) {
    EXPECT_LE(range(blocks[lower], &model::MarkPoint::y_mm).second,
              range(blocks[lower + 1], &model::MarkPoint::y_mm).first);
    if (lower > 0) {
      EXPECT_LE(range(blocks[lower - 2], &model::MarkPoint::x_mm).second,
                range(blocks[lower], &model::MarkPoint::x_mm).first);
    }
  }
}

}  // namespace
}  // namespace chaintrue::grid
