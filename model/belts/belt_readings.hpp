// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lengths that a router on four belts prints at a position, with effects of belt_effects.cpp,
/// applied one after the other.
///
///   L   belt from the anchor's true position: (1) of belt_kinematics.hpp, for machines that print
///       belt_and_arm hypot(m, c) - e
///   T   the belt's tension, with the anchors as they are set: belt_statics.hpp
///   K   the count: L plus what each effect adds, given L and T
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
///   const auto printed = read_belt(machine, effects::resolve(belt_effects(), wrong), {Belt::bl, kLowerBeltsPulled, 3}, place);
/// \endcode
#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "model/belts/belt_effects.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "model/belts/belt_statics.hpp"

namespace chaintrue::model::belts {

/// A belt at a visit.
struct BeltVisit {
  Belt belt = Belt::tl;
  /// Which of the four their motors pull at the reading; the others hold.
  PerBelt<bool> pulled{};
  int order = 0;
  double pull = 1.0;  ///< pull of the pulled belts, relative to the pull that sizes refer to
};

/// An effect at this side acts on this belt.
bool acts_on(effects::EffectSide side, Belt belt);

/// A reading without effects.
AnchorNumber of_anchor(const BeltReading& reading, Belt belt);

/// The printed length, with derivatives by every anchor, since tensions depend on all four.
[[nodiscard]] tl::expected<AnchorNumber, BeltFailure> read_belt(
    const BeltMachine& machine, const std::vector<effects::ActingEffect>& effects,
    const BeltVisit& visit, FramePoint place);

}  // namespace chaintrue::model::belts
