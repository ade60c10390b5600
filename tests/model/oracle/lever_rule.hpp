// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A pose by hand: the eight steps of the community's "Accuracy Issues and Calibration Overview",
/// with each iteration reported. An independent oracle for the solver, and a measure of the error
/// of stopping early.
///
///   1  the sled with its ring is one lump of mass;
///   2  the lump is divided between the chains, at first by the lever rule from its position;
///   3  each part is replaced by a length of the same chain that weighs as much;
///   4  each real chain with its substitute is its own catenary, both with the same horizontal
///      tension,
///   5  at first that of straight lines;
///   6  each catenary is flat where its substitute ends (its lowest point), and its arc from there
///      gives
///   7  the highest point, on the sprocket's tangent, and the tip of the real chain (with its
///      stretch);
///   8  the angles there give the tangent point and the ring's end. The gap between the
///      sprockets corrects the tension (by the ratio of the distances) and the division (by the gap in
///      height over its slope).
///
/// The steps do not define the update; with this one the iterations converge linearly, a few
/// hundred at most over the bed. Ring sled only. Stateless; allocates its list of passes.
///
/// \code
///   const auto result = lever_rule_pose(equilibrium_parameters(machine), {1701.7, 1701.7});
///   for (const LeverRulePass& pass : result->passes) say(pass.gap_across_mm);
/// \endcode
#pragma once

#include <vector>

#include "model/kinematics.hpp"

namespace chaintrue::model {

/// One round of the eight steps.
struct LeverRulePass {
  double horizontal_n = 0.0;
  double left_share_n = 0.0;  ///< of the sled's weight
  /// The bit's position from each chain, hung from its sprocket.
  PerSide<BedPoint> bit;
  double gap_across_mm = 0.0;     ///< left bit beyond the right one, towards +x
  double gap_in_height_mm = 0.0;  ///< left bit above the right one
};

struct LeverRuleResult {
  Pose pose;  ///< at the mean of the last pass's two bits
  std::vector<LeverRulePass> passes;
};

struct LeverRuleOptions {
  int most_passes = 1000;
  double gap_mm = 1e-10;  ///< converged when both gaps are smaller
};

/// \returns not_converged after most_passes, too_short where straight chains do not meet. \throws
/// std::invalid_argument for brackets and for a weightless chain, whose substitute would be
/// infinitely long.
[[nodiscard]] tl::expected<LeverRuleResult, PoseFailure> lever_rule_pose(
    const EquilibriumParameters& parameters,
    ChainLengths lengths,
    const LeverRuleOptions& options = {});

}  // namespace chaintrue::model
