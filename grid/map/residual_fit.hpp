// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two ways of making a map, behind fit(), and the fit that one of them stands on.
#pragma once

#include <string>

#include "grid/map/fit.hpp"
#include "grid/map/points_fit.hpp"

namespace chaintrue::grid {

/// A grid's points fitted: as its noise was stated, or as it was found.
struct FittedGrid {
  PointsFitInput input;
  PointsFit fit;
  std::string noise_source;  ///< as MapNoise has it
  /// Takes the place of the surface where readings without noise stand on a lattice.
  std::optional<LatticeResidual> lattice;
};

/// What goes into a fit of the grid's points, as its noise is stated.
[[nodiscard]] PointsFitInput points_input(const MeasuredGrid& grid,
                                          const std::vector<LengthPoint>& points);
/// Readings can put a machine where no machine is: fails in words.
[[nodiscard]] tl::expected<void, FitFailure> check_machine_read(const MeasuredGrid& grid);

/// Fails where a third of the points contradict the others.
[[nodiscard]] tl::expected<FittedGrid, FitFailure> fit_grid(const MeasuredGrid& grid,
                                                            const Progress& progress = {});
/// An estimate's failure as that of a fit.
[[nodiscard]] FitFailure failure_of(const estimation::EstimationFailure& failure);

/// SurfaceKind::residual
[[nodiscard]] tl::expected<CompensationMap, FitFailure> fit_residual(
    const MeasuredGrid& grid, const Progress& progress = {});
/// SurfaceKind::direct
[[nodiscard]] tl::expected<CompensationMap, FitFailure> fit_direct(const MeasuredGrid& grid,
                                                                   const FitOptions& options);

}  // namespace chaintrue::grid
