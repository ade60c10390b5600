// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Adapts a fit of belts to the pipeline's interface.
#include "tools/gcode/belt_target.hpp"

#include "model/belts/belt_controller.hpp"

namespace chaintrue::gcode {
namespace {

CorrectionFailure from(model::BeltFailure failure) {
  return {CorrectionFailure::unreachable, model::pose_failure(failure)};
}

}  // namespace

tl::expected<model::ChainLengths, CorrectionFailure> BeltTarget::lengths(
    model::BedPoint point) const {
  if (map_.status(point) == grid::MapStatus::outside)
    return tl::unexpected(CorrectionFailure::outside_map);
  const auto found = map_.lengths(point);
  if (!found) return tl::unexpected(from(found.error()));
  return *found;
}

tl::expected<TargetAnswer, CorrectionFailure> BeltTarget::query(model::BedPoint point) const {
  const auto found = lengths(point);
  if (!found) return tl::unexpected(found.error());
  return TargetAnswer{*found, map_.sigma(point), status(point)};
}

TargetStatus BeltTarget::status(model::BedPoint point) const {
  switch (map_.status(point)) {
    case grid::MapStatus::inside:
      return TargetStatus::inside;
    case grid::MapStatus::edge:
      return TargetStatus::edge;
    default:
      return TargetStatus::extrapolated;
  }
}

tl::expected<model::BedPoint, CorrectionFailure> BeltTarget::tool(
    model::ChainLengths lengths) const {
  const auto found = map_.tool(lengths);
  if (!found) return tl::unexpected(from(found.error()));
  return *found;
}

BedRectangle BeltTarget::bounds() const {
  const auto& domain = map_.domain();
  return {domain.x_min, domain.x_max, domain.y_min, domain.y_max};
}

}  // namespace chaintrue::gcode
