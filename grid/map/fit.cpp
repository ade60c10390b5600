// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fit.hpp"

#include "grid/map/corrected_data.hpp"
#include "grid/map/residual_fit.hpp"

namespace chaintrue::grid {

tl::expected<CompensationMap, FitFailure> fit(const MeasuredGrid& grid, const FitOptions& options) {
  const auto corrected = corrected_data(grid);
  if (!corrected) return tl::unexpected(corrected.error());
  auto map = options.surface == SurfaceKind::direct ? fit_direct(corrected->grid, options)
                                                    : fit_residual(corrected->grid);
  if (!map || corrected->notes.empty()) return map;
  MapContents contents = map->contents();
  contents.notes.insert(contents.notes.begin(), corrected->notes.begin(), corrected->notes.end());
  return CompensationMap(std::move(contents));
}

}  // namespace chaintrue::grid
