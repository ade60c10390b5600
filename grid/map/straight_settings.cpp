// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/straight_settings.hpp"

#include <vector>

#include "grid/map/controller_error.hpp"
#include "grid/map/settings_to_type.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

/// From x and y of the left anchor and the left chain's count, x of the right anchor and the right
/// chain's count, and y of the right anchor unless both are level.
StraightSettings settings_of(const VectorXd& unknowns) {
  StraightSettings settings;
  settings.anchors = {{unknowns[0], unknowns[1]},
                      {unknowns[3], unknowns[unknowns.size() == 6 ? 5 : 1]}};
  settings.more_steps = {unknowns[2], unknowns[4]};
  return settings;
}

/// The unknowns of straight chains for the stated machine.
VectorXd start_of(const Machine& machine, Anchors anchors) {
  const auto& motors = machine.motors;
  VectorXd start(6);
  start << motors.left.x_mm, motors.left.y_mm, 1.0, motors.right.x_mm, 1.0, motors.right.y_mm;
  if (anchors == Anchors::free) return start;
  start[1] = 0.5 * (start[1] + start[5]);
  return start.head(5);
}

/// (1)
PaidOut paid_out_by(const StraightSettings& settings, ChainLengths at_origin) {
  return [=](BedPoint command) -> std::optional<ChainLengths> {
    ChainLengths lengths = at_origin;
    for (const Side side : kSides) {
      const BedPoint anchor = settings.anchors[side];
      lengths[side] += settings.more_steps[side] *
                       (distance_mm(command, anchor) - distance_mm(BedPoint{}, anchor));
    }
    return lengths;
  };
}

}  // namespace

std::string_view sentence_of(StraightReason reason) {
  switch (reason) {
    case StraightReason::no_machine:
      return "this map was made without a machine, so its anchors are unknown: fit the points "
             "again with --machine, and without --surface direct";
    case StraightReason::no_origin:
      return "the map does not cover 0, 0, where such a controller is switched on";
    case StraightReason::not_converged:
      break;
  }
  return "no anchors with straight lines approximate this map";
}

tl::expected<StraightSettings, StraightFailure> straight_settings(const CompensationMap& map,
                                                                  Anchors anchors) {
  if (map.machine() == nullptr) return tl::unexpected(StraightReason::no_machine);
  const std::vector<MeasuredPlace> places = measured_places(map, MapFrame::marks);
  const auto origin = map.lengths(MarkPoint{0.0, 0.0});
  if (!origin || places.empty()) return tl::unexpected(StraightReason::no_origin);
  const ErrorsAt errors_at = [&](const VectorXd& unknowns) {
    return controller_errors(paid_out_by(settings_of(unknowns), origin->lengths), places);
  };
  VectorXd unknowns = start_of(*map.machine(), anchors);
  constexpr int kMostSteps = 50;
  // Far below the typed resolution, 1e-4 mm.
  constexpr double kConverged = 1e-7;
  bool converged = false;
  for (int step = 0; step < kMostSteps && !converged; ++step) {
    const auto line = linearised(errors_at, unknowns);
    const VectorXd change = linear::least_squares(line->by_value, -line->errors);
    if (!change.allFinite()) break;
    unknowns += change;
    converged = change.lpNorm<Eigen::Infinity>() < kConverged;
  }
  if (!converged) return tl::unexpected(StraightReason::not_converged);
  StraightSettings result = settings_of(unknowns);
  for (const Side side : kSides)
    result.longer_mm[side] = distance_mm(BedPoint{}, result.anchors[side]) - origin->lengths[side];
  result.left_over = summary_of_errors(places, *errors_at(unknowns));
  return result;
}

}  // namespace chaintrue::grid
