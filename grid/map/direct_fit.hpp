// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// SurfaceKind::direct, behind fit(). Private to grid/map.
#pragma once

#include "grid/map/fit.hpp"

namespace chaintrue::grid {

[[nodiscard]] tl::expected<CompensationMap, FitFailure> fit_direct(const MeasuredGrid& grid,
                                                                   const FitOptions& options);

}  // namespace chaintrue::grid
