// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The catalogue's effects as a set of distances sees them: how large each is beyond what settings
/// can imitate, and which look alike. By secants at the nominal strength, whitened by
/// K = V + A P A'.
#pragma once

#include <vector>

#include "grid/planning/holes_plan.hpp"

namespace chaintrue::grid {

/// Largest first. Effects of the paper, and those that depend on the visit, are left out: distances
/// between holes know neither. \throws std::invalid_argument for a set without a machine.
[[nodiscard]] std::vector<SeenEffect> seen_effects(const MeasuredHoles& set);

}  // namespace chaintrue::grid
