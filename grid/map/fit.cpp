// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fit.hpp"

#include "grid/map/corrected_data.hpp"
#include "grid/map/direct_fit.hpp"
#include "grid/map/joint_fit.hpp"

namespace chaintrue::grid {

tl::expected<CompensationMap, FitFailure> fit(const MeasuredGrid& grid, const FitOptions& options) {
  if (options.surface == SurfaceKind::residual) {
    return joint_fit(grid, {.outside = options.outside, .progress = options.progress})
        .map([](JointFit&& fit) { return std::move(fit.map); });
  }
  const auto corrected = corrected_data(grid);
  if (!corrected) return tl::unexpected(corrected.error());
  auto map = fit_direct(corrected->grid, options);
  const bool as_it_is = corrected->notes.empty() && options.outside.way == Outside::continued;
  if (!map || as_it_is) return map;
  MapContents contents = map->contents();
  contents.notes.insert(contents.notes.begin(), corrected->notes.begin(), corrected->notes.end());
  contents.outside = options.outside;
  return CompensationMap(std::move(contents));
}

}  // namespace chaintrue::grid
