// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Gross errors in points with lengths or commands, found before anything is fitted.
///
/// A reading, through the machine as stated, tells where the tool was; the mark says so too. What
/// is between them is smooth and small for every machine (robust_trend, with what is known of motors
/// and sheets beforehand). Where it is neither, each error of the list is corrected and the two accounts
/// are compared: an error is named where its correction makes the file more than a hundred times
/// likelier, for each of all the errors that were tried.
#pragma once

#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::input_checks {

/// Nothing of a grid without a possible machine.
[[nodiscard]] Findings check_points(const MeasuredGrid& grid, Written written = Written::in_json);

}  // namespace chaintrue::grid::input_checks
