// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/measured_region.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp {
namespace {

double cross(const PlanePoint& o, const PlanePoint& a, const PlanePoint& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

double along(const PlanePoint& direction, const ValueGradient& z) {
  return direction.x * z.dx + direction.y * z.dy;
}

// How much the slope along near.direction changes with the foot point's way along the edge, by a
// central difference.
double turn(const Surface& surface, const NearestPoint& near, const PlanePoint& tangent) {
  const Rectangle domain = surface.domain();
  const double step = 1e-4 * std::max(domain.width(), domain.height());
  const auto outward_at = [&](double s) {
    return along(near.direction,
                 surface.at(near.point.x + s * tangent.x, near.point.y + s * tangent.y));
  };
  return (outward_at(step) - outward_at(-step)) / (2.0 * step);
}

}  // namespace

ConvexHull::ConvexHull(const std::vector<PlanePoint>& points) {
  std::vector<PlanePoint> sorted = points;
  for (const PlanePoint& p : sorted) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      throw std::invalid_argument(fmt::format("a point of the region is ({}, {})", p.x, p.y));
    }
  }
  std::sort(sorted.begin(), sorted.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  const auto half = [this](auto begin, auto end) {
    const std::size_t base = corners_.size();
    for (auto it = begin; it != end; ++it) {
      while (corners_.size() >= base + 2 &&
             cross(corners_[corners_.size() - 2], corners_.back(), *it) <= 0.0) {
        corners_.pop_back();
      }
      corners_.push_back(*it);
    }
    corners_.pop_back();  // the other half starts with it
  };
  if (sorted.size() >= 3) {
    half(sorted.begin(), sorted.end());
    half(sorted.rbegin(), sorted.rend());
  }
  const double span = sorted.empty() ? 0.0
                                     : std::hypot(sorted.back().x - sorted.front().x,
                                                  sorted.back().y - sorted.front().y);
  if (corners_.size() < 3 || !(area() > 1e-12 * span * span)) {
    throw std::invalid_argument(
        fmt::format("{} points on one line enclose no region", points.size()));
  }
}

bool ConvexHull::contains(double x, double y) const {
  const PlanePoint p{x, y};
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (!(cross(corners_[i], corners_[(i + 1) % corners_.size()], p) >= 0.0)) {
      return false;
    }
  }
  return true;
}

NearestPoint ConvexHull::nearest(double x, double y) const {
  NearestPoint best{{x, y}, 0.0, {0.0, 0.0}, false};
  if (contains(x, y)) {
    return best;
  }
  best.distance = HUGE_VAL;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const PlanePoint& a = corners_[i];
    const PlanePoint& b = corners_[(i + 1) % corners_.size()];
    const double ex = b.x - a.x;
    const double ey = b.y - a.y;
    const double s = ((x - a.x) * ex + (y - a.y) * ey) / (ex * ex + ey * ey);
    const double t = std::clamp(s, 0.0, 1.0);
    const PlanePoint foot{a.x + t * ex, a.y + t * ey};
    const double distance = std::hypot(x - foot.x, y - foot.y);
    if (distance < best.distance) {
      best = {foot, distance, {}, s > 0.0 && s < 1.0};
      if (best.on_edge) {
        // The edge's own normal: the difference of two nearby points has no significant digits.
        const double length = std::hypot(ex, ey);
        best.direction = {ey / length, -ex / length};
      } else if (distance > 0.0) {
        best.direction = {(x - foot.x) / distance, (y - foot.y) / distance};
      }
    }
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
  if (!(policy.edge_width >= 0.0) || !(policy.fade_width > 0.0)) {
    throw std::invalid_argument(
        fmt::format("an edge of width {} and a fade of {}", policy.edge_width, policy.fade_width));
  }
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) return {};
  const NearestPoint near = hull.nearest(at.x, at.y);
  if (near.distance == 0.0) return surface.at(at.x, at.y);
  const bool is_clamped = policy.outside == OutsidePolicy::clamp;
  const PlanePoint& n = near.direction;
  const PlanePoint t{-n.y, n.x};
  const ValueGradient foot = surface.at(near.point.x, near.point.y);
  const double outward = is_clamped ? 0.0 : along(n, foot);
  // From a corner the foot does not move: the direction turns instead.
  double across = is_clamped && !near.on_edge ? 0.0 : along(t, foot);
  if (!is_clamped && near.on_edge) across += near.distance * turn(surface, near, t);
  const ValueGradient z{foot.value + near.distance * outward, outward * n.x + across * t.x,
                        outward * n.y + across * t.y};
  if (policy.outside != OutsidePolicy::fade) return z;
  const double s = std::clamp((near.distance - policy.edge_width) / policy.fade_width, 0.0, 1.0);
  const double weight = (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s);
  const double fall = -6.0 * s * (1.0 - s) / policy.fade_width;
  return {weight * z.value, weight * z.dx + fall * n.x * z.value,
          weight * z.dy + fall * n.y * z.value};
}

}  // namespace chaintrue::interp
