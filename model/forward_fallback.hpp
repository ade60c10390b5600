// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The point for chain lengths by a damped Newton on inverse(): slower than the direct closure and
/// for every kinematics alike, it serves where the direct one does not settle and where there is
/// none.
#pragma once

#include "model/inverse_domain.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {

/// Straight lines from the axes to a common point: the guess that every forward starts from.
/// Lengths past 12 o'clock with the ring; wrap taken from the guess's own angles. A point below the
/// beam where the circles do not meet.
struct CircleGuess {
  BedPoint point;
  bool circles_meet = false;
  bool hopeless = false;  ///< no chain stretches that far (20 %)
};
[[nodiscard]] CircleGuess circle_guess(const DomainLimits& limits, ChainLengths lengths);

/// \returns the pose of `kinematics.inverse` whose lengths are these to 1e-9 mm; `too_short` where
/// the chains cannot meet, else `not_converged`.
[[nodiscard]] PoseResult forward_by_inverse(const Kinematics& kinematics,
                                            const DomainLimits& limits,
                                            ChainLengths lengths);

}  // namespace chaintrue::model
