// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The point for chain lengths by a damped Newton on inverse(). Slower than the direct closure and
/// independent of the kinematics; used where the direct closure does not converge and where there
/// is none.
#pragma once

#include "model/inverse_domain.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {

/// Straight lines from the axes to a common point: the initial guess of every forward solution.
/// Lengths are past 12 o'clock and include the ring; the wrap is taken from the guess's own angles.
/// If the circles do not meet, a point below the beam.
struct CircleGuess {
  BedPoint point;
  bool circles_meet = false;
  bool hopeless = false;  ///< more than 20 % stretch would be needed, or these are no lengths
};
CircleGuess circle_guess(const DomainLimits& limits, ChainLengths lengths);

/// \returns the pose of `kinematics.inverse` whose lengths are these to 1e-9 mm; `too_short` where
/// the chains cannot meet, else `not_converged`.
[[nodiscard]] PoseResult forward_by_inverse(const Kinematics& kinematics,
                                            const DomainLimits& limits, ChainLengths lengths);

}  // namespace chaintrue::model
