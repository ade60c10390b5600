// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/measured_area.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace chaintrue::grid {
namespace {

using model::BedPoint;

constexpr std::array<std::string_view, 4> kNames = {"inside", "edge", "extrapolated", "outside"};

/// Twice the signed area of the triangle a, b, c: positive where they turn left.
double turn(BedPoint a, BedPoint b, BedPoint c) {
  return (b.x_mm - a.x_mm) * (c.y_mm - a.y_mm) - (b.y_mm - a.y_mm) * (c.x_mm - a.x_mm);
}

/// Andrew's monotone chain (Inform. Process. Lett. 9 (1979) 216-219).
std::vector<BedPoint> convex_hull(std::vector<BedPoint> points) {
  std::sort(points.begin(), points.end(), [](BedPoint a, BedPoint b) {
    return std::tie(a.x_mm, a.y_mm) < std::tie(b.x_mm, b.y_mm);
  });
  std::vector<BedPoint> hull;
  const auto grow = [&hull](BedPoint point, std::size_t floor) {
    while (hull.size() >= floor + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0)
      hull.pop_back();
    hull.push_back(point);
  };
  for (BedPoint point : points) grow(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin(); point != points.rend(); ++point) grow(*point, lower);
  hull.pop_back();
  return hull;
}

double area(const std::vector<BedPoint>& hull) {
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < hull.size(); ++i) twice += turn(hull[0], hull[i], hull[i + 1]);
  return 0.5 * twice;
}

double distance_to_segment(BedPoint p, BedPoint a, BedPoint b) {
  const double dx = b.x_mm - a.x_mm;
  const double dy = b.y_mm - a.y_mm;
  const double length2 = dx * dx + dy * dy;
  const double along = ((p.x_mm - a.x_mm) * dx + (p.y_mm - a.y_mm) * dy) / length2;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x_mm - a.x_mm - t * dx, p.y_mm - a.y_mm - t * dy);
}

}  // namespace

std::string_view name(MapStatus status) { return kNames[static_cast<std::size_t>(status)]; }

MeasuredArea::MeasuredArea(const std::vector<BedPoint>& points, const interp::Rectangle& domain)
    : MeasuredArea(convex_hull(points), 0.0, domain) {
  // Half the side of the square that each point has to itself.
  edge_mm_ = 0.5 * std::sqrt(area(hull_) / static_cast<double>(points.size()));
}

MeasuredArea::MeasuredArea(std::vector<BedPoint> hull,
                           double edge_mm,
                           const interp::Rectangle& domain)
    : hull_(std::move(hull)), edge_mm_(edge_mm), domain_(domain) {
  if (hull_.size() < 3 || !(area(hull_) > 0.0)) {
    throw std::invalid_argument(
        fmt::format("a measured area needs 3 corners that turn left, got {}", hull_.size()));
  }
}

MapStatus MeasuredArea::status(BedPoint mark) const {
  if (!domain_.contains(mark.x_mm, mark.y_mm)) return MapStatus::outside;
  double outside_by = 0.0;
  bool inside = true;
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < hull_.size(); ++i) {
    const BedPoint a = hull_[i];
    const BedPoint b = hull_[(i + 1) % hull_.size()];
    inside = inside && turn(a, b, mark) >= 0.0;
    nearest = std::min(nearest, distance_to_segment(mark, a, b));
  }
  if (!inside) outside_by = nearest;
  if (outside_by == 0.0) return MapStatus::inside;
  return outside_by <= edge_mm_ ? MapStatus::edge : MapStatus::extrapolated;
}

}  // namespace chaintrue::grid
