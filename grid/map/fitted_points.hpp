// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The results of an estimate (grid/estimation) for points with their chain lengths.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/estimation/estimate.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/observation/tape_distances.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// One point after the fit, with its residuals in the chains.
struct FittedPoint : estimation::UnitEstimate {
  LengthPoint point;
  Matrix2d mark_jacobian;  ///< d(lengths)/d(mark)
};

/// The points that are the estimate's observation of that number.
std::vector<FittedPoint> fitted_points(const std::vector<LengthPoint>& points,
                                       const estimation::Estimate& estimate,
                                       std::size_t observation);

/// Points, and blocks of them, left out; without bad ones.
MapAccuracy held_out_accuracy(const std::vector<FittedPoint>& points);

/// Each point of the map alongside the grid's machine as stated.
std::vector<MapPoint> map_points(const std::vector<FittedPoint>& points, const MeasuredGrid& grid,
                                 const observation::PointNoise& noise);

struct LatticeFit {
  LatticeResidual residual;
  /// Measured minus predicted by the lines through the point, in the order of the points.
  std::vector<Vector2d> left_out_residual_mm;
};

/// Interpolates the residuals of an estimate without its penalised surface. Empty unless the points are
/// single nodes of a lattice of at least 4 x 4 lines with at most a tenth of the nodes empty, the
/// readings are free of noise (with noise the fit has clearly fewer effective parameters than
/// readings), and the lines predict left-out points nearly as well.
std::optional<LatticeFit> fit_lattice(const estimation::Estimate& estimate,
                                      const std::vector<FittedPoint>& points);

// The results of an estimate (grid/estimation) for distances between holes: settings (each
// stated one is a datum with its sigma), a length scale of either chain, the sheet's placement if
// its edges were measured and, if the distances support it, a smooth correction of the chain
// lengths. Where the holes are follows from these (tape_distances.hpp).

struct FittedDistance {
  double measured_mm = 0.0;  ///< without the tape's zero offset
  double commanded_mm = 0.0;
  double predicted_mm = 0.0;  ///< by the fitted machine
  /// Measured less predicted by a fit without this reading, and one sigma of that.
  double left_out_mm = 0.0;
  double left_out_sigma_mm = 0.0;
  bool rejected = false;
  double sigmas() const { return left_out_mm / left_out_sigma_mm; }
};

/// The common excess of a file's readings, if the tape's zero offset was not known exactly.
struct FoundTapeZero {
  double mm = 0.0;
  double sigma_mm = 0.0;
};

struct FittedHole {
  ChainLengths lengths;  ///< paid out
  MarkPoint as_stated;   ///< where the machine as stated puts it, in the sheet's frame
  MarkPoint predicted;   ///< where the fitted machine puts it
  MarkPoint place;       ///< where the distances put it
};

/// An estimate's results for one set of distances among its observations.
struct FittedDistances {
  std::size_t file = 0;  ///< the observation's number
  std::vector<FittedDistance> distances;
  std::vector<FittedHole> holes;
  std::optional<FoundTapeZero> tape_zero;
};

/// The input of a map of holes.
DistancesUsed distances_used(const std::vector<FittedDistance>& distances, double tape_sigma_mm);

/// The surface's intervals: some twenty distances can show only a bend of the whole bed.
inline constexpr int kHolesIntervalsX = 4;
inline constexpr int kHolesIntervalsY = 3;
/// The bed, as far as a sheet may reach beyond it.
interp::Rectangle holes_domain(const Bed& bed);

}  // namespace chaintrue::grid
