// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/taped_ends.hpp"

#include <Eigen/LU>
#include <cmath>

#include "grid/failed.hpp"
#include "grid/plane_vectors.hpp"

namespace chaintrue::grid::observation {
namespace {

using MaybePlaced = tl::expected<PlacedEnd, model::MechanismFailure>;

MaybePlaced placed(const Mechanism& mechanism, const TapeEnd& end, const ToolPosition& place) {
  const Index parameters = mechanism.values().size();
  if (const auto* hole = std::get_if<AtHole>(&end)) return placed_hole(mechanism, *hole);
  if (const auto* fixed = std::get_if<AtFixedPoint>(&end)) {
    const model::FixedPoint point = mechanism.fixed_points().at(fixed->index);
    return PlacedEnd{vector_of(point.at), point.by_parameter};
  }
  return PlacedEnd{vector_of(place), Matrix2Xd::Zero(2, parameters)};
}

}  // namespace

tl::expected<PlacedEnd, model::MechanismFailure> placed_hole(const Mechanism& mechanism,
                                                             const AtHole& hole) {
  constexpr model::MechanismReason kNoHole{"no_hole",
                                           "the lengths that were paid out for a hole do not meet"};
  const auto at = locate_by_newton(mechanism, hole.lengths_mm, {}, hole.meant, hole.deciding);
  if (!at) return failed(at);
  const auto there = mechanism.predict(*at, {});
  if (!there) return failed(there);
  // Lengths that do not meet have a nearest position, but no hole.
  constexpr double kTogetherMm = 1e-6;
  for (const auto i : each_index(hole.deciding)) {
    const auto row = as_index(i);
    if (hole.deciding[i] &&
        !(std::abs(hole.lengths_mm[row] - there->lengths_mm[row]) < kTogetherMm))
      return tl::unexpected(kNoHole);
  }
  Matrix2d by_position;
  Matrix2Xd by_parameter(2, mechanism.values().size());
  Index row = 0;
  for (std::size_t i = 0; i < hole.deciding.size() && row < 2; ++i) {
    if (!hole.deciding[i]) continue;
    by_position.row(row) = there->by_position.row(as_index(i));
    by_parameter.row(row++) = there->by_parameter.row(as_index(i));
  }
  return PlacedEnd{vector_of(*at), -by_position.inverse() * by_parameter};
}

tl::expected<DistanceLine, model::MechanismFailure> distance_line(
    const Mechanism& mechanism, const TapedDistance& distance,
    const std::array<ToolPosition, 2>& places) {
  const auto from = placed(mechanism, distance.from, places[0]);
  if (!from) return failed(from);
  const auto to = placed(mechanism, distance.to, places[1]);
  if (!to) return failed(to);
  const model::FrameScale scale = mechanism.frame_scale();
  const Vector2d way = to->at - from->at;
  const RowVector2d along = scale.factor * way.normalized().transpose();
  return DistanceLine{
      scale.factor * way.norm(),
      {-along, along},
      along * (to->by_parameter - from->by_parameter) + way.norm() * scale.by_parameter};
}

}  // namespace chaintrue::grid::observation
