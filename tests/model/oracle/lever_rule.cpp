// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/oracle/lever_rule.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/equilibrium_newton.hpp"
#include "model/forward_fallback.hpp"

namespace chaintrue::model {
namespace {

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

ChainState state_of(const EquilibriumConstants& m,
                    double h_n,
                    double share_n,
                    const HungChain& chain) {
  ChainState state;
  state.horizontal_n = h_n;
  state.vertical_at_sled_n = share_n;
  state.tension_at_sled_n = std::hypot(h_n, share_n);
  state.tension_at_sprocket_n = std::hypot(h_n, share_n + m.chain.weight_n_per_mm * chain.free_mm);
  state.angle_rad = chain.top_angle_rad;
  state.free_length_mm = chain.free_mm;
  state.wrap_mm = m.wrap(chain.top_angle_rad);
  return state;
}

}  // namespace

tl::expected<LeverRuleResult, PoseFailure> lever_rule_pose(const EquilibriumParameters& parameters,
                                                           ChainLengths lengths,
                                                           const LeverRuleOptions& options) {
  if (!std::holds_alternative<Ring>(parameters.attachment)) {
    throw std::invalid_argument("the lever rule's procedure needs a ring sled, not brackets");
  }
  if (!(parameters.chain_weight_n_per_mm > 0.0) || parameters.side_force_n != 0.0 ||
      parameters.beam_flexibility_mm_per_n != 0.0) {
    throw std::invalid_argument(
        "the lever rule's procedure needs a chain with weight, no side force and a rigid beam");
  }
  const EquilibriumConstants m = equilibrium_constants(parameters);
  const DomainLimits limits = limits_of(m);
  const CircleGuess guess = circle_guess(limits, lengths);
  if (!guess.circles_meet) return tl::unexpected(PoseReason::too_short);
  const double spacing = m.motors.right.x_mm - m.motors.left.x_mm;
  // Steps 2 and 5, the sled's weight alone on straight lines to the axes.
  double share_n = m.W * (m.motors.right.x_mm - guess.point.x_mm) / spacing;
  const double slope_left =
      (m.motors.left.y_mm - guess.point.y_mm) / (guess.point.x_mm - m.motors.left.x_mm);
  double h_n = share_n / slope_left;

  LeverRuleResult result;
  for (int n = 0; n < options.most_passes; ++n) {
    const HungChain left = hang(m, h_n, share_n, lengths.left_mm);
    const HungChain right = hang(m, h_n, m.W - share_n, lengths.right_mm);
    LeverRulePass pass;
    pass.horizontal_n = h_n;
    pass.left_share_n = share_n;
    pass.bit = {bit_of(m, Side::left, left), bit_of(m, Side::right, right)};
    pass.gap_across_mm = pass.bit.left.x_mm - pass.bit.right.x_mm;
    pass.gap_in_height_mm = pass.bit.left.y_mm - pass.bit.right.y_mm;
    result.passes.push_back(pass);
    if (std::abs(pass.gap_across_mm) < options.gap_mm &&
        std::abs(pass.gap_in_height_mm) < options.gap_mm) {
      Pose& pose = result.pose;
      pose.position = {0.5 * (pass.bit.left.x_mm + pass.bit.right.x_mm),
                       0.5 * (pass.bit.left.y_mm + pass.bit.right.y_mm)};
      if (const auto failure = domain_failure(limits, pose.position))
        return tl::unexpected(*failure);
      pose.lengths = lengths;
      pose.chains = {state_of(m, h_n, share_n, left), state_of(m, h_n, m.W - share_n, right)};
      pose.iterations = n + 1;
      return result;
    }
    // Chains that span more than the sprockets' distance have too small a horizontal tension.
    h_n *= spacing / (spacing + pass.gap_across_mm);
    // If the left bit is too high, its chain carries too little.
    share_n += pass.gap_in_height_mm / (left.rise_by_share + right.rise_by_share);
    share_n = std::clamp(share_n, 0.0, m.W);
  }
  return tl::unexpected(PoseReason::not_converged);
}

}  // namespace chaintrue::model
