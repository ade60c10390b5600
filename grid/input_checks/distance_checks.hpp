// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Gross errors in taped distances between holes, found before anything is fitted: as in
/// check_points, with a trend in the sheet's place, the machine's scales and the tape's zero offset
/// between commanded and measured distances.
#pragma once

#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid::input_checks {

/// Rows are distances.
Findings check_distances(const MeasuredHoles& set, Written written = Written::in_json);

}  // namespace chaintrue::grid::input_checks
