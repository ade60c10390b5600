// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/oracle/lever_rule.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/model/reference_tables.hpp"

namespace chaintrue::model {
namespace {

TEST(LeverRule, SettlesAtTheReferencePose) {
  double worst_weightless = 0.0, worst_gap = 0.0, worst_position = 0.0, gap_sum = 0.0,
         passes_sum = 0.0;
  std::size_t most_passes = 0;
  for (const char* name : {"table_over_top.json", "table_off_bottom.json"}) {
    const nlohmann::json table = reference_table(name);
    const EquilibriumParameters m = parameters_of(table["params"]);
    for (const auto& r : table["bed"]) {
      const BedPoint p = point_of(r);
      SCOPED_TRACE(testing::Message() << name << " at (" << p.x_mm << ", " << p.y_mm << ")");
      const auto result =
          lever_rule_pose(m, {number(r["d_elastic"][0]), number(r["d_elastic"][1])});
      ASSERT_TRUE(result) << result.error().sentence();
      // Gaps of 1e-10 mm between the tips, and a + asinh forms that lose 1e-10 mm to cancellation.
      EXPECT_NEAR(result->pose.position.x_mm, p.x_mm, 2e-9);
      EXPECT_NEAR(result->pose.position.y_mm, p.y_mm, 2e-9);
      EXPECT_NEAR(result->pose.chains.left.horizontal_n, number(r["d_state"]["H"]), 1e-9);
      const BedPoint weightless =
          make_kinematics(m, Model::wrap)->forward(result->pose.lengths)->position;
      worst_weightless = std::max(worst_weightless,
                                  std::hypot(weightless.x_mm - p.x_mm, weightless.y_mm - p.y_mm));
      const LeverRulePass& first = result->passes.front();
      const double gap = std::hypot(first.gap_across_mm, first.gap_in_height_mm);
      const double position =
          std::hypot(0.5 * (first.bit.left.x_mm + first.bit.right.x_mm) - p.x_mm,
                     0.5 * (first.bit.left.y_mm + first.bit.right.y_mm) - p.y_mm);
      worst_gap = std::max(worst_gap, gap);
      worst_position = std::max(worst_position, position);
      gap_sum += gap;
      most_passes = std::max(most_passes, result->passes.size());
      passes_sum += static_cast<double>(result->passes.size());
    }
  }
  // The figures of model/README.md, rounded there: before the first iteration the two chains' ends
  // are up to 277 mm apart.
  EXPECT_NEAR(worst_weightless, 5.3, 0.1);
  EXPECT_NEAR(worst_gap, 277.0, 1.0);
  EXPECT_NEAR(gap_sum / 234.0, 64.0, 1.0);
  EXPECT_NEAR(worst_position, 131.0, 1.0);
  EXPECT_NEAR(passes_sum / 234.0, 136.0, 2.0);
  EXPECT_LE(most_passes, 320u);
}

TEST(LeverRule, GapsShrinkFromPassToPass) {
  Machine machine;
  const EquilibriumParameters m = equilibrium_parameters(machine);
  const ChainLengths lengths = make_kinematics(m)->inverse({500.0, -300.0})->lengths;
  const auto result = lever_rule_pose(m, lengths);
  ASSERT_TRUE(result);
  ASSERT_GT(result->passes.size(), 20u);
  const auto gap = [&](std::size_t i) {
    return std::hypot(result->passes[i].gap_across_mm, result->passes[i].gap_in_height_mm);
  };
  // Linear convergence: ten passes always gain.
  for (std::size_t i = 10; i + 1 < result->passes.size(); i += 10)
    EXPECT_LT(gap(i), 0.9 * gap(i - 10));
}

TEST(LeverRule, RefusesUnsupportedMachines) {
  Machine machine;
  EquilibriumParameters m = equilibrium_parameters(machine);
  EXPECT_EQ(lever_rule_pose(m, {900.0, 900.0}).error(), PoseReason::too_short);
  const ChainLengths lengths = make_kinematics(m)->inverse({500.0, -300.0})->lengths;
  EXPECT_EQ(lever_rule_pose(m, lengths, {.most_passes = 3}).error(), PoseReason::not_converged);
  m.chain_weight_n_per_mm = 0.0;
  EXPECT_THROW(std::ignore = lever_rule_pose(m, lengths), std::invalid_argument);
  m = equilibrium_parameters(machine);
  m.attachment = Brackets{};
  EXPECT_THROW(std::ignore = lever_rule_pose(m, lengths), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model
