// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Gross slips in points with lengths or commands, found before anything is fitted.
///
/// A reading, through the machine as stated, tells where the tool was; the mark says so too. What
/// is between them is smooth and small for every machine (robust_trend, with what is known of motors
/// and sheets beforehand). Where it is neither, each slip of the list is mended and the two accounts
/// are compared: a slip is named where it makes the file more than a hundred times likelier, for
/// each of all the slips that were tried.
#pragma once

#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::input_checks {

/// Nothing of a grid without a possible machine.
[[nodiscard]] Findings point_slips(const MeasuredGrid& grid);

}  // namespace chaintrue::grid::input_checks
