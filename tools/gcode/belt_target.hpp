// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of four belts as the target of G-code: the lengths of its upper two belts for a position
/// of the tool, and the inverse. `left` is the top left belt.
#pragma once

#include "grid/belts/belt_map.hpp"
#include "tools/gcode/target_map.hpp"

namespace chaintrue::gcode {

class BeltTarget final : public TargetMap {
 public:
  explicit BeltTarget(grid::BeltMap map) : map_(std::move(map)) {}

  [[nodiscard]] tl::expected<model::ChainLengths, CorrectionFailure> lengths(
      model::BedPoint point) const override;
  [[nodiscard]] tl::expected<TargetAnswer, CorrectionFailure> query(
      model::BedPoint point) const override;
  [[nodiscard]] TargetStatus status(model::BedPoint point) const override;
  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> tool(
      model::ChainLengths lengths) const override;
  [[nodiscard]] BedRectangle bounds() const override;

 private:
  grid::BeltMap map_;
};

}  // namespace chaintrue::gcode
