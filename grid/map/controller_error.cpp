// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/controller_error.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "grid/containers.hpp"
#include "grid/map/largest_error.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/raster.hpp"
#include "model/controllers/payout.hpp"

namespace chaintrue::grid {
namespace {

constexpr int kColumns = 25;
constexpr int kRows = 13;

/// d(left, right)/d(x, y) by steps towards `middle`, where the map answers if it answers at `at`.
std::optional<Matrix2d> jacobian_at(const LengthMap& map, BedPoint at, ChainLengths here,
                                    BedPoint middle) {
  // The error of a one-sided step is half of it over a chain's length, 5e-6; that of rounding 1e-7.
  constexpr double kStepMm = 0.01;
  Matrix2d jacobian;
  for (const Index axis : {0, 1}) {
    BedPoint there = at;
    double& moved = axis == 0 ? there.x_mm : there.y_mm;
    const double step = (axis == 0 ? middle.x_mm : middle.y_mm) < moved ? -kStepMm : kStepMm;
    moved += step;
    const auto lengths = map.lengths(there);
    if (!lengths) return std::nullopt;
    jacobian.col(axis) = difference(*lengths, here) / step;
  }
  return jacobian;
}

}  // namespace

std::vector<MeasuredPlace> measured_places(const LengthMap& map,
                                           const std::vector<BedPoint>& hull) {
  const interp::ConvexHull area = hull_of(hull);
  interp::Rectangle box{hull[0].x_mm, hull[0].x_mm, hull[0].y_mm, hull[0].y_mm};
  for (const BedPoint corner : hull) take_in(box, model::identity_placement(corner));
  const BedPoint middle{0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)};
  std::vector<MeasuredPlace> places;
  const auto add = [&](BedPoint at, bool is_on_edge) {
    const auto lengths = map.lengths(at);
    if (!lengths) return;
    const auto jacobian = jacobian_at(map, at, *lengths, middle);
    if (!jacobian) return;
    places.push_back({at, *lengths, jacobian->inverse(), map.tool_spread(at), is_on_edge});
  };
  for (const MarkPoint& mark : raster(box, kColumns, kRows, RasterOf::cells)) {
    if (area.contains(mark.x_mm, mark.y_mm)) add(model::identity_placement(mark), false);
  }
  const double spacing = std::max(box.width() / kColumns, box.height() / kRows);
  const auto& corners = area.corners();
  for (const auto i : each_index(corners)) {
    const interp::PlanePoint from = corners[i], to = corners[(i + 1) % corners.size()];
    const double steps = std::ceil(std::hypot(to.x - from.x, to.y - from.y) / spacing);
    for (double step = 0.0; step < steps; step += 1.0)
      add({from.x + (to.x - from.x) * step / steps, from.y + (to.y - from.y) * step / steps}, true);
  }
  return places;
}

std::vector<MeasuredPlace> measured_places(const CompensationMap& map, MapFrame frame) {
  std::vector<BedPoint> hull;
  for (const MarkPoint corner : map.contents().hull) {
    hull.push_back(frame == MapFrame::bed ? map.to_bed(corner) : model::identity_placement(corner));
  }
  return measured_places(MapInFrame(map, frame), hull);
}

PaidOut paid_out_by(const Machine& machine) {
  return [controller = std::shared_ptr(model::make_controller_kinematics(machine))](
             BedPoint command) -> std::optional<ChainLengths> {
    const auto lengths = controller->lengths(command);
    return lengths ? std::optional(*lengths) : std::nullopt;
  };
}

std::optional<VectorXd> controller_errors(const PaidOut& paid_out,
                                          const std::vector<MeasuredPlace>& places) {
  VectorXd errors(2 * std::ssize(places));
  for (const auto i : each_index(places)) {
    const auto lengths = paid_out(places[i].commanded);
    if (!lengths) return std::nullopt;
    errors.segment<2>(2 * as_index(i)) =
        places[i].to_tool * difference(*lengths, places[i].lengths);
  }
  return errors;
}

ErrorSummary summary_of_errors(const std::vector<MeasuredPlace>& places,
                               const VectorXd& errors_mm) {
  LargestError largest;
  double squares_mm2 = 0.0;
  int within = 0;
  for (const auto i : each_index(places)) {
    const Vector2d expected_mm = errors_mm.segment<2>(2 * as_index(i));
    largest.add(expected_mm, places[i].spread_mm);
    if (places[i].is_on_edge) continue;
    squares_mm2 += expected_mm.squaredNorm() + places[i].spread_mm.squaredNorm();
    ++within;
  }
  return {std::sqrt(squares_mm2 / std::max(within, 1)), largest.bound_mm()};
}

namespace {

/// An ideal controller uses the machine file. What a diagnosis added later did not affect the
/// commands.
bool is_controller_machine(const Machine& machine) {
  return machine.controller.kind != model::ControllerKind::ideal ||
         none_of(machine.effects,
                 [](const auto& effect) { return effect.probability.has_value(); });
}

}  // namespace

std::optional<ErrorSummary> error_in_use(const CompensationMap& map) {
  // A controller without stated settings uses the file, not the calibration.
  const auto machine = stated_machine(map);
  if (!machine || !is_controller_machine(*machine)) return std::nullopt;
  const std::vector<MeasuredPlace> places = measured_places(map, MapFrame::marks);
  if (places.empty()) return std::nullopt;
  const auto errors = controller_errors(paid_out_by(*machine), places);
  if (!errors) return std::nullopt;
  return summary_of_errors(places, *errors);
}

void measure_expected_error(const CompensationMap& map, MapAccuracy& accuracy) {
  const std::vector<MeasuredPlace> places = measured_places(map, MapFrame::marks);
  if (places.empty()) return;
  accuracy.expected_tool = summary_of_errors(places, VectorXd::Zero(2 * std::ssize(places)));
  // A place's mirror image differs by less, through rounding: the first is kept.
  constexpr double kWorse = 1.0 + 1e-6;
  double worst_mm = -1.0;
  for (const MeasuredPlace& place : places) {
    if (place.spread_mm.norm() <= kWorse * worst_mm) continue;
    worst_mm = place.spread_mm.norm();
    accuracy.expected_worst_at = {place.commanded.x_mm, place.commanded.y_mm};
  }
}

}  // namespace chaintrue::grid
