// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "grid/map/holes_fit.hpp"
#include "grid/map/map_parts.hpp"

namespace chaintrue::grid {

using model::MarkPoint;

MapPoint map_point(const FittedHole& hole) {
  MapPoint point;
  point.mark = hole.place;
  point.lengths = hole.lengths;
  const auto beside = [&hole](MarkPoint from) {
    return Eigen::Vector2d(hole.place.x_mm - from.x_mm, hole.place.y_mm - from.y_mm);
  };
  point.as_stated_mm = point.sheet_placed_mm = beside(hole.as_stated);
  point.mapped_mm = point.left_out_mm = beside(hole.predicted);
  return point;
}

CompensationMap map_of(const MeasuredHoles& set, const HolesFit& fit) {
  if (!set.machine) throw std::invalid_argument("a map of holes stands on a machine");
  MapContents map;
  map.name = set.name;
  map.surface = model_surface(fit.estimate);
  map.domain = holes_domain(set.machine->bed);
  std::vector<MarkPoint> places;
  for (const FittedHole& hole : fit.holes) places.push_back(hole.predicted);
  const MeasuredArea area(places, map.domain);
  map.hull = area.hull();
  map.edge_mm = area.edge_mm();
  map.noise = {0.0, set.hole_sigma_mm, "stated", fit.estimate.noise_factor};
  map.settings = setting_results(*set.machine, fit.estimate, std::nullopt);
  for (const FittedHole& hole : fit.holes) map.points.push_back(map_point(hole));
  map.notes = fit.notes;
  map.distances = distances_used(fit.distances, set.tape.sigma_mm);
  map.accuracy.leave_one_out.tool = map.accuracy.leave_one_out.chain = fit.left_out_good;
  map.accuracy.blocked = map.accuracy.leave_one_out;
  return with_expected_error(std::move(map));
}

}  // namespace chaintrue::grid
