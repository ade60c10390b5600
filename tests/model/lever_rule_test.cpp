// SPDX-License-Identifier: GPL-3.0-or-later
// A pose by hand: the eight steps of the community's "Accuracy Issues and Calibration Overview",
// with each iteration reported. An independent oracle for the solver, and a measure of the error
// of stopping early.
//
//   1  the sled with its ring is one lump of mass;
//   2  the lump is divided between the chains, at first by the lever rule from its position;
//   3  each part is replaced by a length of the same chain that weighs as much;
//   4  each real chain with its substitute is its own catenary, both with the same horizontal
//      tension,
//   5  at first that of straight lines;
//   6  each catenary is flat where its substitute ends (its lowest point), and its arc from there
//      gives
//   7  the highest point, on the sprocket's tangent, and the tip of the real chain (with its
//      stretch);
//   8  the angles there give the tangent point and the ring's end. The gap between the
//      sprockets corrects the tension (by the ratio of the distances) and the division (by the gap in
//      height over its slope).
//
// The steps do not define the update; with this one the iterations converge linearly, a few
// hundred at most over the bed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/equilibrium_newton.hpp"
#include "model/forward_fallback.hpp"
#include "model/kinematics.hpp"
#include "tests/model/reference_tables.hpp"

namespace chaintrue::model {
namespace {

/// One round of the eight steps.
struct LeverRulePass {
  double horizontal_n = 0.0;
  /// The bit's position from each chain, hung from its sprocket.
  PerSide<BedPoint> bit;

  /// The left bit from the right one: towards +x, and above it.
  [[nodiscard]] BedPoint gap() const {
    return {bit.left.x_mm - bit.right.x_mm, bit.left.y_mm - bit.right.y_mm};
  }
  [[nodiscard]] double gap_mm() const { return std::hypot(gap().x_mm, gap().y_mm); }
  [[nodiscard]] double off_mm(BedPoint p) const {
    return std::hypot(0.5 * (bit.left.x_mm + bit.right.x_mm) - p.x_mm,
                      0.5 * (bit.left.y_mm + bit.right.y_mm) - p.y_mm);
  }
};

/// A catenary from its lowest point: y = a cosh(x / a), arc = a sinh(x / a), stretched by
/// compliance times tension.
struct HungChain {
  double across_mm = 0.0;  ///< tip to tangent point
  double rise_mm = 0.0;
  double top_angle_rad = 0.0, tip_angle_rad = 0.0;
  double free_mm = 0.0;
  double rise_by_share = 0.0;  ///< mm/N, slope of the tip's depth by the weight it carries
};

/// Steps 3, 4, 6 and 7 for one chain. The free length and the top angle depend on each other:
/// solved by fixed-point iteration, whose error decreases in each step by the ratio of the
/// sprocket's radius to the chain's radius of curvature.
HungChain hang(const EquilibriumConstants& m, double h_n, double share_n, double length_mm) {
  const double w = m.chain.weight_n_per_mm, c = m.chain.compliance_per_n;
  const double a = h_n / w, substitute = share_n / w;
  HungChain chain;
  chain.tip_angle_rad = std::atan2(share_n, h_n);
  chain.free_mm = length_mm;
  for (int n = 0; n < 50; ++n) {
    chain.top_angle_rad = std::atan2(substitute + chain.free_mm, a);
    const double next = length_mm - m.wrap(chain.top_angle_rad);
    const bool converged = std::abs(next - chain.free_mm) < 1e-13 * length_mm;
    chain.free_mm = next;
    if (converged) break;
  }
  const double top = substitute + chain.free_mm;
  chain.across_mm =
      a * (std::asinh(top / a) - std::asinh(substitute / a)) + c * h_n * chain.free_mm;
  chain.rise_mm = std::hypot(a, top) - std::hypot(a, substitute) +
                  c * w * 0.5 * (top - substitute) * (top + substitute);
  chain.rise_by_share =
      top / std::hypot(a, top) / w - substitute / std::hypot(a, substitute) / w + c * chain.free_mm;
  return chain;
}

/// Step 8: the bit, from the sprocket's axis via tangent point, chain and ring.
BedPoint bit_of(const EquilibriumConstants& m, Side side, const HungChain& chain) {
  const double towards = side == Side::left ? 1.0 : -1.0;
  const double across = m.sg * m.r * std::sin(chain.top_angle_rad) + chain.across_mm +
                        m.rho * std::cos(chain.tip_angle_rad);
  const double down = -m.sg * m.r * std::cos(chain.top_angle_rad) + chain.rise_mm +
                      m.rho * std::sin(chain.tip_angle_rad);
  return {m.motors[side].x_mm + towards * across, m.motors[side].y_mm - down};
}

/// Of a ring sled with heavy chains, no side force and a rigid beam.
std::vector<LeverRulePass> lever_rule(const EquilibriumParameters& parameters,
                                      ChainLengths lengths) {
  const EquilibriumConstants m = equilibrium_constants(parameters);
  const BedPoint guess = circle_guess(limits_of(m), lengths).point;
  const double spacing = m.motors.right.x_mm - m.motors.left.x_mm;
  // Steps 2 and 5, the sled's weight alone on straight lines to the axes.
  double share_n = m.W * (m.motors.right.x_mm - guess.x_mm) / spacing;
  const double slope_left = (m.motors.left.y_mm - guess.y_mm) / (guess.x_mm - m.motors.left.x_mm);
  double h_n = share_n / slope_left;

  std::vector<LeverRulePass> passes;
  for (int n = 0; n < 1000; ++n) {
    const HungChain left = hang(m, h_n, share_n, lengths.left_mm);
    const HungChain right = hang(m, h_n, m.W - share_n, lengths.right_mm);
    passes.push_back({h_n, {bit_of(m, Side::left, left), bit_of(m, Side::right, right)}});
    const auto [across_mm, in_height_mm] = passes.back().gap();
    if (std::max(std::abs(across_mm), std::abs(in_height_mm)) < 1e-10) break;
    // Chains that span more than the sprockets' distance have too small a horizontal tension.
    h_n *= spacing / (spacing + across_mm);
    // If the left bit is too high, its chain carries too little.
    share_n += in_height_mm / (left.rise_by_share + right.rise_by_share);
    share_n = std::clamp(share_n, 0.0, m.W);
  }
  return passes;
}

TEST(LeverRule, SettlesAtTheReferencePoseByShrinkingGaps) {
  double worst_weightless = 0.0, worst_gap = 0.0, worst_position = 0.0, gap_sum = 0.0,
         passes_sum = 0.0;
  std::size_t most_passes = 0;
  for (const char* name : {"table_over_top.json", "table_off_bottom.json"}) {
    const nlohmann::json table = reference_table(name);
    const EquilibriumParameters m = parameters_of(table["params"]);
    for (const auto& r : table["bed"]) {
      const BedPoint p = point_of(r);
      SCOPED_TRACE(testing::Message() << name << " at (" << p.x_mm << ", " << p.y_mm << ")");
      const ChainLengths lengths{number(r["d_elastic"][0]), number(r["d_elastic"][1])};
      const std::vector<LeverRulePass> passes = lever_rule(m, lengths);
      // Gaps of 1e-10 mm between the tips, and a + asinh forms that lose 1e-10 mm to cancellation.
      EXPECT_LT(passes.back().off_mm(p), 2e-9);
      EXPECT_NEAR(passes.back().horizontal_n, number(r["d_state"]["H"]), 1e-9);
      const BedPoint weightless = make_kinematics(m, Model::wrap)->forward(lengths)->position;
      worst_weightless = std::max(worst_weightless,
                                  std::hypot(weightless.x_mm - p.x_mm, weightless.y_mm - p.y_mm));
      worst_gap = std::max(worst_gap, passes.front().gap_mm());
      worst_position = std::max(worst_position, passes.front().off_mm(p));
      gap_sum += passes.front().gap_mm();
      most_passes = std::max(most_passes, passes.size());
      passes_sum += static_cast<double>(passes.size());
      // Linear convergence: ten passes always gain.
      for (std::size_t i = 10; i + 1 < passes.size(); i += 10)
        ASSERT_LT(passes[i].gap_mm(), 0.9 * passes[i - 10].gap_mm()) << i;
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

}  // namespace
}  // namespace chaintrue::model
