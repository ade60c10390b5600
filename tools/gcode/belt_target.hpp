// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of four belts as the target of G-code: what its upper two belts must be for a place of the
/// tool, and back. `left` is the top left belt.
#pragma once

#include "grid/belts/belt_map.hpp"
#include "tools/gcode/target_map.hpp"

namespace chaintrue::gcode {

class BeltTarget final : public TargetMap {
 public:
  /// Without a known scale nothing is known of the tool's error in true millimetres.
  explicit BeltTarget(grid::BeltMap map, bool knows_scale = true)
      : map_(std::move(map)), knows_scale_(knows_scale) {}

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
  bool knows_scale_;
};

}  // namespace chaintrue::gcode
