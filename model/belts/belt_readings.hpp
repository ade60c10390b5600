// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lengths that a router on four belts prints at a position, with effects of
/// effects/belt_effects.def, applied one after the other.
///
///   L   the belt from the anchor as it really is: (1) of belt_kinematics.hpp, for machines that print
///       belt_and_arm hypot(m, c) - e
///   K   L and what each effect adds: the count
///   print(K)  K, K + e, or sqrt(K^2 - c^2) + e, with the height c that is set in the machine
///
/// Without effects it equals reading_at().
///
/// \code
///   const std::vector<AppliedEffect> wrong = {{"belt_stretch", "", {{"elongation", 0.004}}}};
///   const auto printed = read_belt(machine, resolve_belt_effects(wrong), {Belt::bl, true, 3}, place);
/// \endcode
#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "model/belts/belt_kinematics.hpp"
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

/// The same with d(print)/d(place). What an effect adds is differentiated by a central difference
/// over 1 mm of belt: exact to rounding for the effects of the table, which are linear in L.
[[nodiscard]] tl::expected<BeltReading, BeltFailure> read_belt_with_slope(
    const BeltMachine& machine,
    const std::vector<ResolvedBeltEffect>& effects,
    const BeltVisit& visit,
    FramePoint place);

}  // namespace chaintrue::model::belts
