// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Gross errors in taped distances between holes, found before anything is fitted: as check_points,
/// with a trend of the sheet's place, the machine's scales and the tape's zero offset between what was
/// commanded and what was read.
#pragma once

#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid::input_checks {

/// Rows are distances.
[[nodiscard]] Findings check_distances(const MeasuredHoles& set,
                                       Written written = Written::in_json);

}  // namespace chaintrue::grid::input_checks
