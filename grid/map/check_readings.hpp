// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New points compared with a compensation map: residuals, their covariance, and the effect of a
/// change of the chains. Private to grid.
#pragma once

#include <tl/expected.hpp>

#include "grid/map/check_evidence.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"
#include "grid/progress.hpp"

namespace chaintrue::grid {

/// Adds independent errors to K of the readings, one sigma a column (n x any). What the rows of a
/// single unit have adds to its noise; others are shared. \pre N and F have their rows.
void add_errors(const Eigen::SparseMatrix<double>& errors, ReadingCovariance& covariance);

/// For all files together, since they share the map's uncertainty. Repeated readings at a mark, or
/// of a distance in one file, are replaced by their mean, which is as informative. Fails before any
/// work if there are too many.
[[nodiscard]] tl::expected<CheckReadings, CheckFailure> check_readings(
    const CompensationMap& map, const Measured& measured, const Progress& progress = {});

}  // namespace chaintrue::grid
