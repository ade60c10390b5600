// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rectangles and hulls of a bed, and points spread evenly over them.
///
/// \code
///   for (const model::MarkPoint& mark : raster(area_of(machine.bed), 25, 13, RasterOf::cells)) ...
/// \endcode
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "grid/containers.hpp"
#include "interp/measured_region.hpp"
#include "model/coordinates.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid {

/// The bed, with `beyond_mm` more on each side.
inline interp::Rectangle area_of(const Bed& bed, double beyond_mm = 0.0) {
  const double x = 0.5 * bed.width_mm + beyond_mm, y = 0.5 * bed.height_mm + beyond_mm;
  return {-x, x, -y, y};
}

/// The hull of marks, or of places on the bed.
template <class Points>
interp::ConvexHull hull_of(const Points& points) {
  std::vector<interp::PlanePoint> in_plane;
  for (const auto& point : points) in_plane.push_back({point.x_mm, point.y_mm});
  return interp::ConvexHull(in_plane);
}

/// Widens `area` to hold `mark`.
inline void take_in(interp::Rectangle& area, MarkPoint mark) {
  area = {std::min(area.x_min, mark.x_mm), std::max(area.x_max, mark.x_mm),
          std::min(area.y_min, mark.y_mm), std::max(area.y_max, mark.y_mm)};
}

/// Nodes reach to the borders; cells have their points in their middles.
enum class RasterOf { nodes, cells };

/// Row by row from y_min, each from x_min. A single row or column of nodes lies in the middle.
/// Symmetric about the middle to the last bit, and exactly there where a row or column is.
inline std::vector<MarkPoint> raster(const interp::Rectangle& over, int columns, int rows,
                                     RasterOf of) {
  const auto share = [of](int i, int count) {
    if (of == RasterOf::cells) return (i + 0.5) / count - 0.5;
    return count > 1 ? as_double(i) / (count - 1) - 0.5 : 0.0;
  };
  const double x = 0.5 * (over.x_min + over.x_max), y = 0.5 * (over.y_min + over.y_max);
  std::vector<MarkPoint> points;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      points.push_back(
          {x + over.width() * share(column, columns), y + over.height() * share(row, rows)});
    }
  }
  return points;
}

/// In whole millimetres, as places are typed and marked, none farther out than before.
inline std::vector<MarkPoint> whole_mm(std::vector<MarkPoint> points) {
  for (MarkPoint& point : points) point = {std::trunc(point.x_mm), std::trunc(point.y_mm)};
  return points;
}

}  // namespace chaintrue::grid
