// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A place's position relative to the measured points: their convex hull, its neighbourhood, and
/// the domain outside which there are no answers.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "grid/raster.hpp"

namespace chaintrue::grid {

/// Part of every answer of a map.
enum class MapStatus {
  inside,        ///< between measured points
  edge,          ///< beyond the outermost points by at most half their spacing
  extrapolated,  ///< farther, but on the bed: continued smoothly, with a larger sigma
  outside,       ///< off the bed, or where the chains cannot hold the sled: no lengths
};

constexpr std::string_view name(MapStatus status) {
  constexpr std::string_view kNames[] = {"inside", "edge", "extrapolated", "outside"};
  return kNames[as_size(status)];
}

/// Immutable, thread safe.
class MeasuredArea {
 public:
  /// `domain` is where answers are given at all. \throws std::invalid_argument for fewer than 3
  /// points.
  MeasuredArea(const std::vector<MarkPoint>& points, const interp::Rectangle& domain)
      : MeasuredArea(points, 0.0, domain) {
    // Half the side of the square that each point has to itself.
    edge_mm_ = 0.5 * std::sqrt(hull_.area() / as_double(points.size()));
  }
  /// From a hull as written in a file: counter-clockwise corners, and half the points' spacing.
  MeasuredArea(const std::vector<MarkPoint>& hull, double edge_mm, const interp::Rectangle& domain)
      : hull_(hull_of(hull)), edge_mm_(edge_mm), domain_(domain) {}

  [[nodiscard]] MapStatus status(MarkPoint mark) const {
    if (!domain_.contains(mark.x_mm, mark.y_mm)) return MapStatus::outside;
    if (hull_.contains(mark.x_mm, mark.y_mm)) return MapStatus::inside;
    const double beyond_mm = hull_.nearest(mark.x_mm, mark.y_mm).distance;
    return beyond_mm <= edge_mm_ ? MapStatus::edge : MapStatus::extrapolated;
  }
  /// Corners, counter-clockwise.
  std::vector<MarkPoint> hull() const {
    std::vector<MarkPoint> corners;
    for (const interp::PlanePoint& corner : hull_.corners())
      corners.push_back({corner.x, corner.y});
    return corners;
  }
  double edge_mm() const { return edge_mm_; }
  const interp::Rectangle& domain() const { return domain_; }

 private:
  interp::ConvexHull hull_;
  double edge_mm_;
  interp::Rectangle domain_;
};

}  // namespace chaintrue::grid
