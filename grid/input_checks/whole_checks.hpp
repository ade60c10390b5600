// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Errors in a file of points: a reversed axis, exchanged columns, a rotated sheet, wrong
/// units, missing minus signs, a tape read from another mark, another origin, slipped lines.
#pragma once

#include <vector>

#include "grid/input_checks/point_accounts.hpp"
#include "grid/input_checks/transformation_search.hpp"

namespace chaintrue::grid::input_checks {

/// The errors possible for such points on `grid`'s machine. All three must outlive the result.
std::vector<Transformation> point_transformations(const PointAccounts& accounts,
                                                  const MeasuredGrid& grid,
                                                  const PlacedPoints& written, Written as);

/// Errors of slipped lines, which need neighbours in the file.
std::vector<Transformation> slip_transformations(const PointAccounts& accounts,
                                                 const PlacedPoints& written);

}  // namespace chaintrue::grid::input_checks
