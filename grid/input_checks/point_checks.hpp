// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Gross errors in points with lengths or commands, found before anything is fitted.
///
/// A reading and the stated machine give the tool's position; so does the mark. Their difference is
/// smooth and small for every machine (robust_trend, with priors of motors and sheets). If it is
/// not, each known error is corrected and the two accounts are compared: an error is reported if
/// its correction makes the file more than a hundred times likelier for each of the errors tried.
#pragma once

#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::input_checks {

/// No findings for a grid without a possible machine.
Findings check_points(const MeasuredGrid& grid, Written written = Written::in_json);

}  // namespace chaintrue::grid::input_checks
