// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The results of an estimate (grid/estimation) for points with their chain lengths.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/estimation/estimate.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/length_points.hpp"

namespace chaintrue::grid {

/// One point after the fit.
struct FittedPoint {
  std::size_t file = 0;  ///< the number of its file
  LengthPoint point;
  bool bad = false;
  double distance = 0.0;  ///< of the left-out residual, in sigmas
  /// Measured minus predicted, in the chains.
  Eigen::Vector2d residual_mm = Eigen::Vector2d::Zero();           ///< of the finished map
  Eigen::Vector2d left_out_residual_mm = Eigen::Vector2d::Zero();  ///< of a map made without this point
  Eigen::Vector2d blocked_residual_mm = Eigen::Vector2d::Zero();   ///< of a map made without its part of the bed
  Eigen::Matrix2d mark_jacobian;         ///< d(lengths)/d(mark)
};

struct PointsFit {
  estimation::Estimate estimate;
  std::vector<FittedPoint> points;  ///< in the order of the observation's
  [[nodiscard]] const model::SheetPlacement& sheet() const {
    return estimate.observations.front().sheet;
  }
};

/// The points that are the estimate's observation of that number.
[[nodiscard]] std::vector<FittedPoint> fitted_points(const std::vector<LengthPoint>& points,
                                                     const estimation::Estimate& estimate,
                                                     std::size_t observation);

/// Points, and blocks of them, left out; without bad ones.
[[nodiscard]] MapAccuracy held_out_accuracy(const std::vector<FittedPoint>& points);

/// Each point of the map alongside the grid's machine as stated.
[[nodiscard]] std::vector<MapPoint> map_points(const std::vector<FittedPoint>& points,
                                               const MeasuredGrid& grid,
                                               const observation::PointNoise& noise);

}  // namespace chaintrue::grid
