// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Adapts a map to the pipeline's interface.
#include "tools/gcode/compensation_target.hpp"

#include "model/calibration/setting.hpp"

namespace chaintrue::gcode {
namespace {

CorrectionFailure from(const grid::MapFailure& failure) {
  switch (failure.reason) {
    case grid::MapFailure::outside_map:
      return CorrectionFailure::outside_map;
    case grid::MapFailure::unreachable:
      return {CorrectionFailure::unreachable, failure.pose};
    case grid::MapFailure::not_converged:
      break;
  }
  return CorrectionFailure::not_converged;
}

TargetStatus from(grid::MapStatus status) {
  switch (status) {
    case grid::MapStatus::inside:
      return TargetStatus::inside;
    case grid::MapStatus::edge:
      return TargetStatus::edge;
    default:
      return TargetStatus::extrapolated;
  }
}

}  // namespace

model::MarkPoint CompensationTarget::mark_of(model::BedPoint point) const {
  return frame_ == ProgramFrame::bed ? map_.to_mark(point) : model::identity_placement(point);
}

tl::expected<model::ChainLengths, CorrectionFailure> CompensationTarget::lengths(
    model::BedPoint point) const {
  const auto found = map_.lengths(mark_of(point));
  if (!found) return tl::unexpected(from(found.error()));
  return found->lengths;
}

tl::expected<TargetAnswer, CorrectionFailure> CompensationTarget::query(
    model::BedPoint point) const {
  const auto found = map_.query(mark_of(point));
  if (!found) return tl::unexpected(from(found.error()));
  return TargetAnswer{found->lengths, found->sigma, from(found->status)};
}

TargetStatus CompensationTarget::status(model::BedPoint point) const {
  return from(map_.status(mark_of(point)));
}

tl::expected<model::BedPoint, CorrectionFailure> CompensationTarget::tool(
    model::ChainLengths lengths) const {
  const auto found = map_.inverse(lengths);
  if (!found) return tl::unexpected(from(found.error()));
  return frame_ == ProgramFrame::bed ? map_.to_bed(*found) : model::identity_placement(*found);
}

BedRectangle CompensationTarget::bounds() const {
  const auto& domain = map_.contents().domain;
  return {domain.x_min, domain.x_max, domain.y_min, domain.y_max};
}

std::optional<model::Machine> stated_machine(const grid::CompensationMap& map) {
  if (map.machine() == nullptr) return std::nullopt;
  model::Machine machine = *map.machine();
  for (const grid::SettingResult& result : map.contents().settings) {
    bool of_machine = false;
    for (const model::Setting setting : model::kMachineSettings)
      of_machine = of_machine || setting == result.setting;
    if (of_machine)
      machine = model::with_setting(std::move(machine), result.setting, result.stated);
  }
  return machine;
}

model::ChainLengths half_play_mm(const model::Machine& machine) {
  model::ChainLengths half;
  for (const model::AppliedEffect& effect : machine.effects) {
    if (effect.effect != "direction_hysteresis") continue;
    const auto width = effect.parameters.find("half_width_mm");
    if (width == effect.parameters.end()) continue;
    if (effect.side != "right") half.left_mm += width->second;
    if (effect.side != "left") half.right_mm += width->second;
  }
  return half;
}

}  // namespace chaintrue::gcode
