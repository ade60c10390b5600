// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/measured_region.hpp"

#include <algorithm>
#include <cmath>

#include "interp/require.hpp"

namespace chaintrue::interp {
namespace {

double cross(const PlanePoint& o, const PlanePoint& a, const PlanePoint& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

Vector2d vector(const PlanePoint& p) { return {p.x, p.y}; }

Vector2d slope_of(const ValueGradient& z) { return {z.dx, z.dy}; }

// How much the slope along near.direction changes with the foot point's way along the edge, by a
// central difference.
double turn(const Surface& surface, const NearestPoint& near, const Vector2d& tangent) {
  const Rectangle domain = surface.domain();
  const double step = 1e-4 * std::max(domain.width(), domain.height());
  const auto outward_at = [&](double s) {
    const Vector2d at = near.point + s * tangent;
    return near.direction.dot(slope_of(surface.at(at.x(), at.y())));
  };
  return (outward_at(step) - outward_at(-step)) / (2.0 * step);
}

}  // namespace

ConvexHull::ConvexHull(const std::vector<PlanePoint>& points) {
  std::vector<PlanePoint> sorted = points;
  for (const PlanePoint& p : sorted) {
    require(std::isfinite(p.x) && std::isfinite(p.y), "a point of the region is ({}, {})", p.x,
            p.y);
  }
  std::sort(sorted.begin(), sorted.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  for (int half = 0; half < 2 && !sorted.empty(); ++half) {
    const std::size_t base = corners_.size();
    for (const PlanePoint& p : sorted) {
      while (corners_.size() >= base + 2 && cross(corners_.end()[-2], corners_.back(), p) <= 0.0)
        corners_.pop_back();
      corners_.push_back(p);
    }
    corners_.pop_back();  // the other half starts with it
    std::reverse(sorted.begin(), sorted.end());
  }
  const double span =
      sorted.empty() ? 0.0 : (vector(sorted.back()) - vector(sorted.front())).norm();
  require(area() > 1e-12 * span * span, "{} points on one line enclose no region", points.size());
}

bool ConvexHull::contains(double x, double y) const {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (!(cross(corners_[i], corners_[(i + 1) % corners_.size()], {x, y}) >= 0.0)) return false;
  }
  return true;
}

NearestPoint ConvexHull::nearest(double x, double y) const {
  const Vector2d at(x, y);
  NearestPoint best{at, 0.0, Vector2d::Zero(), false};
  if (contains(x, y)) return best;
  best.distance = HUGE_VAL;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vector2d from = vector(corners_[i]);
    const Vector2d edge = vector(corners_[(i + 1) % corners_.size()]) - from;
    const double s = (at - from).dot(edge) / edge.squaredNorm();
    const Vector2d foot = from + std::clamp(s, 0.0, 1.0) * edge;
    const double distance = (at - foot).norm();
    if (!(distance < best.distance)) continue;
    const bool on_edge = s > 0.0 && s < 1.0;
    // The edge's own normal: the difference of two nearby points has no significant digits.
    const Vector2d outward = on_edge ? Vector2d(edge.y(), -edge.x()) : at - foot;
    best = {foot, distance, outward.normalized(), on_edge};
  }
  return best;
}

double ConvexHull::area() const {
  double twice = 0.0;
  for (std::size_t i = 0; i + 1 < corners_.size(); ++i) {
    twice += cross(corners_.front(), corners_[i], corners_[i + 1]);
  }
  return 0.5 * twice;
}

ValueGradient evaluate(const Surface& surface, const ConvexHull& hull, const RegionPolicy& policy,
                       const PlanePoint& at) {
  require(policy.edge_width >= 0.0 && policy.fade_width > 0.0,
          "an edge of width {} and a fade of {}", policy.edge_width, policy.fade_width);
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) return {};
  const NearestPoint near = hull.nearest(at.x, at.y);
  if (near.distance == 0.0) return surface.at(at.x, at.y);
  const bool is_clamped = policy.outside == OutsidePolicy::clamp;
  const Vector2d& n = near.direction;
  const Vector2d t(-n.y(), n.x());
  const ValueGradient foot = surface.at(near.point.x(), near.point.y());
  const double outward = is_clamped ? 0.0 : n.dot(slope_of(foot));
  // From a corner the foot does not move: the direction turns instead.
  double across = is_clamped && !near.on_edge ? 0.0 : t.dot(slope_of(foot));
  if (!is_clamped && near.on_edge) across += near.distance * turn(surface, near, t);
  double value = foot.value + near.distance * outward;
  Vector2d slope = outward * n + across * t;
  if (policy.outside == OutsidePolicy::fade) {
    const double s = std::clamp((near.distance - policy.edge_width) / policy.fade_width, 0.0, 1.0);
    const double weight = (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s);
    const double fall = -6.0 * s * (1.0 - s) / policy.fade_width;
    slope = weight * slope + fall * value * n;
    value *= weight;
  }
  return {value, slope.x(), slope.y()};
}

}  // namespace chaintrue::interp
