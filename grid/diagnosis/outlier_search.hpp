// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sets of units (points, or distances) that some hypothesis would rather do without.
#pragma once

#include <vector>

#include "grid/diagnosis/evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Flags per unit, the most probable set first; units that are excluded beforehand stay flagged in
/// all of them. `hypotheses` are sets of regressors.
[[nodiscard]] std::vector<std::vector<bool>> outlier_sets(
    const RegressorSystem& system,
    const std::vector<bool>& excluded,
    const std::vector<std::vector<int>>& hypotheses,
    const Steps& steps);

}  // namespace chaintrue::grid::diagnosis
