// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From measured points to a compensation map.
///
/// \code
///   const auto map = fit(grid);
///   if (!map) fmt::print("{}\n", map.error().sentence());
/// \endcode
#pragma once

#include <tl/expected.hpp>

#include "grid/map/compensation_map.hpp"
#include "grid/progress.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

enum class SurfaceKind {
  residual,  ///< the calibrated machine and a smooth correction of its residuals
  direct,  ///< splines through the lengths themselves; points on full rows and columns, no machine
};

struct FitOptions {
  SurfaceKind surface = SurfaceKind::residual;
  /// End conditions of the direct surface.
  interp::TensorEnds ends;
  /// The map's continuation beyond the points.
  OutsideRule outside;
  Progress progress{};
};

enum class FitReason {
  no_machine,  ///< the residual surface needs one
  not_a_grid,  ///< the direct surface needs full rows and columns
  no_lengths,  ///< a point gives a command that its controller cannot reach, or no controller is
               ///< stated
  point_unreachable,  ///< the stated machine cannot hold the sled at a point
  rank_deficient,
  impossible_readings,  ///< no machine is possible with the grid's readings
  not_converged,
};
using FitFailure = Failure<FitReason>;

/// The machine's effects of the paper and of the visit (drift, skips, hysteresis) are removed from
/// the data first (corrected_data.hpp) and are not in the map; its other effects are.
/// \throws std::invalid_argument if `fade` is requested for a direct surface (see CompensationMap).
[[nodiscard]] tl::expected<CompensationMap, FitFailure> fit(const MeasuredGrid& grid,
                                                            const FitOptions& options = {});

}  // namespace chaintrue::grid
