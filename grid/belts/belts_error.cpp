// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belts_error.hpp"

#include <algorithm>
#include <cmath>

#include "grid/belts/belt_map.hpp"
#include "grid/map/controller_error.hpp"
#include "model/belts/belt_controller.hpp"

namespace chaintrue::grid {
namespace {

bool anchors_were_known(const BeltsFit& fit) {
  return std::all_of(fit.coordinates.begin(),
                     fit.coordinates.end(),
                     [](const AnchorCoordinate& one) { return one.stated_mm.has_value(); });
}

/// Nobody knows the anchors in force: the sheet is laid by the fitted ones.
BeltsFit by_its_own_anchors(BeltsFit fit) {
  for (AnchorCoordinate& one : fit.coordinates) one.stated_mm = one.fitted_mm;
  return fit;
}

std::optional<ErrorSummary> error_today(const BeltMap& map,
                                        const std::vector<model::BedPoint>& places) {
  const model::BeltController controller(map.in_force());
  Eigen::VectorXd errors(2 * static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto paid_out = controller.lengths(places[i]);
    if (!paid_out) return std::nullopt;
    const auto tool = map.tool(*paid_out);
    if (!tool) return std::nullopt;
    errors.segment<2>(2 * static_cast<Eigen::Index>(i)) << tool->x_mm - places[i].x_mm,
        tool->y_mm - places[i].y_mm;
  }
  return summary_of_errors(errors);
}

}  // namespace

std::optional<BeltsError> error_of_belts(const BeltsFit& fit, const HolesWithBelts* holes) {
  constexpr std::size_t kFewestPlaces = 3;  // a map's hull
  if (holes == nullptr && fit.places.size() < kFewestPlaces) return std::nullopt;
  const bool knows_today = holes != nullptr || anchors_were_known(fit);
  const BeltMap map(knows_today ? fit : by_its_own_anchors(fit), holes);
  std::vector<model::BedPoint> places = raster_over(map.domain());
  std::erase_if(places, [&map](model::BedPoint at) {
    return map.status(at) != MapStatus::inside || !map.lengths(at);
  });
  if (places.empty()) return std::nullopt;

  BeltsError error;
  if (knows_today) error.today = error_today(map, places);
  const auto displacement = holes != nullptr && holes->displacement
                                ? std::optional<ToolDisplacement>(*holes->displacement)
                                : std::nullopt;
  double squares_mm2 = 0.0;
  for (const model::BedPoint at : places) {
    double error_mm = map.tool_sigma_mm(at);
    if (displacement) error_mm = std::hypot(error_mm, displacement->at({at.x_mm, at.y_mm}).norm());
    squares_mm2 += error_mm * error_mm;
    if (error_mm <= error.expected.maximum_mm) continue;
    error.expected.maximum_mm = error_mm;
    error.worst_at = at;
  }
  error.expected.rms_mm = std::sqrt(squares_mm2 / static_cast<double>(places.size()));
  return error;
}

}  // namespace chaintrue::grid
