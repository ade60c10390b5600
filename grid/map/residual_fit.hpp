// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two ways of making a map, behind fit().
#pragma once

#include "grid/map/fit.hpp"

namespace chaintrue::grid {

/// SurfaceKind::residual
[[nodiscard]] tl::expected<CompensationMap, FitFailure> fit_residual(const MeasuredGrid& grid);
/// SurfaceKind::direct
[[nodiscard]] tl::expected<CompensationMap, FitFailure> fit_direct(const MeasuredGrid& grid,
                                                                   const FitOptions& options);

}  // namespace chaintrue::grid
