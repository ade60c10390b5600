// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The catalogue's effects as observed by a set of distances: the size of each after projection on
/// the settings, and which of them are collinear. Secants at the nominal strength, whitened by K =
/// V + A P A'.
#pragma once

#include <vector>

#include "grid/planning/holes_plan.hpp"

namespace chaintrue::grid {

/// Largest first. Effects of the paper, and those that depend on the visit, are left out: distances
/// between holes do not depend on either. \throws std::invalid_argument for a set without a
/// machine.
[[nodiscard]] std::vector<DetectableEffect> detectable_effects(const MeasuredHoles& set);

}  // namespace chaintrue::grid
