// SPDX-License-Identifier: GPL-3.0-or-later
// The uncertainty of a map grows by the difference of two others, only where they differ.
#include "grid/map/largest_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "grid/map/fit.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue::grid {
namespace {

CompensationMap map_of_seed(std::uint64_t seed) {
  return fit(synthetic::generate(model::Machine{}, testing_support::usual_spec(seed)).value().grid)
      .value();
}

TEST(LargerError, ADifferenceOfMapsIsADirectionOfTheTool) {
  const CompensationMap map = map_of_seed(1), from = map_of_seed(2), to = map_of_seed(3);
  constexpr double kShare = 0.5;
  const CompensationMap wider = with_differences(map, {{from, to, kShare}});
  double most_mm = 0.0;
  for (double x = -1100.0; x <= 1100.0; x += 220.0) {
    for (double y = -550.0; y <= 550.0; y += 110.0) {
      const auto before = map.query({x, y}).value(), after = wider.query({x, y}).value();
      EXPECT_EQ(before.lengths.left_mm, after.lengths.left_mm);
      EXPECT_EQ(before.lengths.right_mm, after.lengths.right_mm);
      const auto low = from.lengths({x, y}).value().lengths,
                 high = to.lengths({x, y}).value().lengths;
      const Eigen::Vector2d sigma_mm(kShare * (high.left_mm - low.left_mm),
                                     kShare * (high.right_mm - low.right_mm));
      const Eigen::Matrix2d added = after.covariance - before.covariance;
      // Splines over half the spacing of the marks follow the difference of machines a few
      // millimetres apart.
      EXPECT_LT((added - sigma_mm * sigma_mm.transpose()).norm(),
                0.02 * sigma_mm.squaredNorm() + 1e-4)
          << x << " " << y;
      most_mm = std::max(most_mm, sigma_mm.norm());
    }
  }
  EXPECT_GT(most_mm, 0.2) << "the maps differ";
  EXPECT_GT(wider.contents().accuracy.expected_tool.rms_mm,
            map.contents().accuracy.expected_tool.rms_mm);
}

TEST(LargerError, AFactorIsThatOfEverySigma) {
  const CompensationMap map = map_of_seed(1), wider = with_larger_error(map, 3.0);
  const auto before = map.query({300.0, -200.0}).value(),
             after = wider.query({300.0, -200.0}).value();
  EXPECT_NEAR(after.tool_sigma_mm, 3.0 * before.tool_sigma_mm, 1e-12);
  EXPECT_THROW((void)with_larger_error(map, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid
