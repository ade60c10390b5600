// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lengths that a router on four belts prints at a position, with effects of
/// effects/belt_effects.def, applied one after the other.
///
///   L   the belt from the anchor as it really is: (1) of belt_kinematics.hpp, for machines that print
///       belt_and_arm hypot(m, c) - e
///   T   the belt's tension, with the anchors as they are set: belt_statics.hpp
///   K   L and what each effect adds, by L and T: the count
///   print(K)  K, K + e, or sqrt(K^2 - c^2) + e, with the height c that is set in the machine
///
/// A print depends on the place less the anchors, so that
///
///   d(print)/d(place) = -sum over the anchors of d(print)/d(anchor)                         (1)
///
/// Without effects it equals reading_at().
///
/// \code
///   const std::vector<AppliedEffect> wrong = {{"belt_stretch", "", {{"elongation", 0.004}}}};
///   const auto printed = read_belt(machine, resolve_belt_effects(wrong), {Belt::bl, kLowerBeltsPulled, 3}, place);
/// \endcode
#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "model/belts/belt_kinematics.hpp"
#include "model/belts/belt_statics.hpp"
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts {

/// An effect of the table at a side, with its values in the order of its parameters.
struct ResolvedBeltEffect {
  const BeltEffect* effect = nullptr;
  BeltSide side = BeltSide::none;
  std::vector<double> values;
};

/// Problems of applied effects: unknown effects, sides and parameters, values out of range. Places
/// are "/0/side" and the like, by the effect's number.
[[nodiscard]] std::vector<MachineProblem> problems_of(const std::vector<AppliedEffect>& applied);
/// Parameters that are not given have their nominal value. \throws std::logic_error for effects with
/// problems.
[[nodiscard]] std::vector<ResolvedBeltEffect> resolve_belt_effects(
    const std::vector<AppliedEffect>& applied);

[[nodiscard]] tl::expected<double, BeltFailure> read_belt(
    const BeltMachine& machine,
    const std::vector<ResolvedBeltEffect>& effects,
    const BeltVisit& visit,
    FramePoint place);

/// A printed length and its derivatives. By each anchor, since tensions depend on all four.
struct BeltReadingSlopes {
  double length_mm = 0.0;
  Eigen::RowVector2d by_place = Eigen::RowVector2d::Zero();
  PerBelt<Eigen::RowVector2d> by_anchor;  ///< (1): by_place is the negative of their sum
};

/// What an effect adds is differentiated by central differences over 1 mm of belt and 1 of tension:
/// exact to rounding for the effects of the table, which are linear in L and in T.
[[nodiscard]] tl::expected<BeltReadingSlopes, BeltFailure> read_belt_with_slope(
    const BeltMachine& machine,
    const std::vector<ResolvedBeltEffect>& effects,
    const BeltVisit& visit,
    FramePoint place);

}  // namespace chaintrue::model::belts
