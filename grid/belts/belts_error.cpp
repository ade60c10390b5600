// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belts_error.hpp"

#include <cmath>

#include "grid/belts/belt_map.hpp"
#include "grid/containers.hpp"
#include "grid/map/controller_error.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_controller.hpp"

namespace chaintrue::grid {
namespace {

bool anchors_were_known(const BeltsFit& fit) {
  return all_of(fit.coordinates, &AnchorCoordinate::stated_mm);
}

/// The anchors in force are unknown: the fitted ones place the sheet.
BeltsFit by_its_own_anchors(BeltsFit fit) {
  for (AnchorCoordinate& one : fit.coordinates) one.stated_mm = one.fitted_mm;
  return fit;
}

}  // namespace

std::optional<BeltsError> error_of_belts(const BeltsFit& fit, const HolesWithBelts* holes) {
  constexpr std::size_t kFewestPlaces = 3;  // a map's hull
  if (holes == nullptr && fit.places.size() < kFewestPlaces) return std::nullopt;
  const bool knows_today = holes != nullptr || anchors_were_known(fit);
  const BeltMap map(knows_today ? fit : by_its_own_anchors(fit), holes);
  const std::vector<MeasuredPlace> places = measured_places(map, map.hull());
  if (places.empty()) return std::nullopt;

  BeltsError error;
  if (knows_today) {
    const model::BeltController controller(map.in_force());
    const auto errors = controller_errors(
        [&controller](BedPoint at) -> std::optional<ChainLengths> {
          const auto paid_out = controller.lengths(at);
          return paid_out ? std::optional(*paid_out) : std::nullopt;
        },
        places);
    if (errors) error.today = summary_of_errors(places, *errors);
  }
  const auto displacement = holes != nullptr && holes->displacement
                                ? std::optional<ToolDisplacement>(*holes->displacement)
                                : std::nullopt;
  VectorXd left_mm = VectorXd::Zero(2 * std::ssize(places));
  double worst_mm = -1.0;
  for (const auto i : each_index(places)) {
    const BedPoint at = places[i].commanded;
    const auto row = 2 * as_index(i);
    if (displacement) left_mm.segment<2>(row) = displacement->at({at.x_mm, at.y_mm});
    const double error_mm = std::hypot(places[i].spread_mm.norm(), left_mm.segment<2>(row).norm());
    if (error_mm <= worst_mm) continue;
    worst_mm = error_mm;
    error.worst_at = at;
  }
  error.expected = summary_of_errors(places, left_mm);
  return error;
}

}  // namespace chaintrue::grid
