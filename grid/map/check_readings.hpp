// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New points held against a compensation map: residuals, their covariance, and what a change of the
/// chains does to them. Private to grid.
#pragma once

#include <tl/expected.hpp>

#include "grid/map/check_evidence.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"
#include "grid/progress.hpp"

namespace chaintrue::grid {

/// Of all files together: what the map does not know of itself they share. Readings at one and the
/// same mark, and of one and the same distance in one file, count as their mean: it says as much
/// of the map as they do. Fails where there are too many (check_parts.hpp), before any work.
[[nodiscard]] tl::expected<CheckReadings, CheckFailure> check_readings(
    const CompensationMap& map, const Measured& measured, const Progress& progress = {});

}  // namespace chaintrue::grid
