// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The region covered by measurements, and the policies for evaluating a surface outside it.
///
/// The measured region is the convex hull of the points. Outside it a surface is continued by a
/// policy.

#include <vector>

#include "interp/eigen.hpp"
#include "interp/surface.hpp"

namespace chaintrue::interp {

/// The nearest point of a region and its distance.
struct NearestPoint {
  Vector2d point;
  double distance;     ///< 0 inside
  Vector2d direction;  ///< unit vector from `point` outward; zero inside
  bool on_edge;        ///< inside of an edge rather than at a corner
};

/// A convex polygon, counterclockwise. Immutable.
class ConvexHull {
 public:
  /// The hull of `points` by A. M. Andrew's monotone chain (Inf. Proc. Letters 9 (1979) 216-219).
  /// Throws std::invalid_argument if the points are not finite or lie on one line.
  explicit ConvexHull(const std::vector<PlanePoint>& points);

  const std::vector<PlanePoint>& corners() const { return corners_; }
  bool contains(double x, double y) const;
  NearestPoint nearest(double x, double y) const;
  double area() const;

 private:
  std::vector<PlanePoint> corners_;
};

enum class OutsidePolicy {
  fade,    ///< the linear continuation times a weight that falls to zero over fade_width
  linear,  ///< the tangent plane at the nearest measured point
  clamp,   ///< the value at the nearest measured point
};

struct RegionPolicy {
  OutsidePolicy outside = OutsidePolicy::fade;
  double edge_width = 0.0;    ///< >= 0
  double fade_width = 200.0;  ///< > 0; for `fade`, counted from edge_width on
};

/// `surface` at (x, y) under the policy: linear up to edge_width outside the hull, but for `clamp`.
/// Continuous across the hull and through every policy's zones; `fade` and `linear` are C1 across the
/// hull's edges. The gradient next to an edge uses a difference of the surface's gradient along the
/// edge (error about 1e-6 of a second derivative). Zero if the place is not finite.
ValueGradient evaluate(const Surface& surface, const ConvexHull& hull, const RegionPolicy& policy,
                       const PlanePoint& at);

}  // namespace chaintrue::interp
