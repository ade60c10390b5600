// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A place's position relative to the measured points: their convex hull, its neighbourhood, and
/// the domain outside which there are no answers.
#pragma once

#include <string_view>
#include <vector>

#include "interp/measured_region.hpp"
#include "interp/surface.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

/// Part of every answer of a map.
enum class MapStatus {
  inside,        ///< between measured points
  edge,          ///< beyond the outermost points by at most half their spacing
  extrapolated,  ///< farther, but on the bed: continued smoothly, with a larger sigma
  outside,       ///< off the bed, or where the chains cannot hold the sled: no lengths
};

[[nodiscard]] std::string_view name(MapStatus status);

/// Immutable, thread safe.
class MeasuredArea {
 public:
  /// `domain` is where answers are given at all. \throws std::invalid_argument for fewer than 3
  /// points.
  MeasuredArea(const std::vector<model::MarkPoint>& points, const interp::Rectangle& domain);
  /// From a hull as written in a file: counter-clockwise corners, and half the points' spacing.
  MeasuredArea(const std::vector<model::MarkPoint>& hull,
               double edge_mm,
               const interp::Rectangle& domain);

  [[nodiscard]] MapStatus status(model::MarkPoint mark) const;
  /// Corners, counter-clockwise.
  [[nodiscard]] std::vector<model::MarkPoint> hull() const;
  [[nodiscard]] double edge_mm() const { return edge_mm_; }
  [[nodiscard]] const interp::Rectangle& domain() const { return domain_; }

 private:
  interp::ConvexHull hull_;
  double edge_mm_;
  interp::Rectangle domain_;
};

}  // namespace chaintrue::grid
