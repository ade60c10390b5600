// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fit.hpp"

#include "grid/map/residual_fit.hpp"

namespace chaintrue::grid {

tl::expected<CompensationMap, FitFailure> fit(const MeasuredGrid& grid, const FitOptions& options) {
  auto map =
      options.surface == SurfaceKind::direct ? fit_direct(grid, options) : fit_residual(grid);
  if (!map || options.outside.way == Outside::continued) return map;
  return map->with_outside(options.outside);
}

}  // namespace chaintrue::grid
