// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fit.hpp"

#include "grid/map/residual_fit.hpp"

namespace chaintrue::grid {

tl::expected<CompensationMap, FitFailure> fit(const MeasuredGrid& grid, const FitOptions& options) {
  return options.surface == SurfaceKind::direct ? fit_direct(grid, options) : fit_residual(grid);
}

}  // namespace chaintrue::grid
