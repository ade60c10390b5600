// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/measured_area.hpp"

#include <array>
#include <cmath>

namespace chaintrue::grid {
namespace {

using model::MarkPoint;

constexpr std::array<std::string_view, 4> kNames = {"inside", "edge", "extrapolated", "outside"};

std::vector<interp::PlanePoint> in_plane(const std::vector<MarkPoint>& points) {
  std::vector<interp::PlanePoint> result;
  for (MarkPoint point : points) result.push_back({point.x_mm, point.y_mm});
  return result;
}

}  // namespace

std::string_view name(MapStatus status) { return kNames[static_cast<std::size_t>(status)]; }

MeasuredArea::MeasuredArea(const std::vector<MarkPoint>& points, const interp::Rectangle& domain)
    : MeasuredArea(points, 0.0, domain) {
  // Half the side of the square that each point has to itself.
  edge_mm_ = 0.5 * std::sqrt(hull_.area() / static_cast<double>(points.size()));
}

MeasuredArea::MeasuredArea(const std::vector<MarkPoint>& hull,
                           double edge_mm,
                           const interp::Rectangle& domain)
    : hull_(in_plane(hull)), edge_mm_(edge_mm), domain_(domain) {}

std::vector<MarkPoint> MeasuredArea::hull() const {
  std::vector<MarkPoint> corners;
  for (const interp::PlanePoint& corner : hull_.corners()) corners.push_back({corner.x, corner.y});
  return corners;
}

MapStatus MeasuredArea::status(MarkPoint mark) const {
  if (!domain_.contains(mark.x_mm, mark.y_mm)) return MapStatus::outside;
  if (hull_.contains(mark.x_mm, mark.y_mm)) return MapStatus::inside;
  const double beyond_mm = hull_.nearest(mark.x_mm, mark.y_mm).distance;
  return beyond_mm <= edge_mm_ ? MapStatus::edge : MapStatus::extrapolated;
}

}  // namespace chaintrue::grid
