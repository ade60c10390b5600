// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The results of an estimate (grid/estimation) for points with their chain lengths.
#pragma once

#include <vector>

#include "grid/eigen.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/length_points.hpp"

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

}  // namespace chaintrue::grid
