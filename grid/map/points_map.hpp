// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of points as a map. Nothing is fitted here.
#pragma once

#include "grid/map/residual_fit.hpp"

namespace chaintrue::grid {

[[nodiscard]] CompensationMap map_of(const MeasuredGrid& grid, const FittedGrid& fitted);

/// Points, and blocks of them, that were left out; bad ones do not count.
[[nodiscard]] MapAccuracy held_out_accuracy(const std::vector<FittedPoint>& points);
/// Each point as the map has it, beside the grid's machine as stated.
[[nodiscard]] std::vector<MapPoint> map_points(const PointsFitInput& input,
                                               const PointsFit& fit,
                                               const MeasuredGrid& grid);

}  // namespace chaintrue::grid
