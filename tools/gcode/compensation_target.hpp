// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map as the target of G-code: lengths, status and inverse in the program's frame.
#pragma once

#include <optional>

#include "grid/map/compensation_map.hpp"
#include "model/machine.hpp"
#include "tools/gcode/target_map.hpp"

namespace chaintrue::gcode {

/// The frame of a program's x and y.
enum class ProgramFrame { marks, bed };

class CompensationTarget final : public TargetMap {
 public:
  /// Keeps a reference.
  explicit CompensationTarget(const grid::CompensationMap& map,
                              ProgramFrame frame = ProgramFrame::marks)
      : map_(map), frame_(frame) {}

  [[nodiscard]] tl::expected<model::ChainLengths, CorrectionFailure> lengths(
      model::BedPoint point) const override;
  [[nodiscard]] tl::expected<TargetAnswer, CorrectionFailure> query(
      model::BedPoint point) const override;
  [[nodiscard]] TargetStatus status(model::BedPoint point) const override;
  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> tool(
      model::ChainLengths lengths) const override;
  [[nodiscard]] BedRectangle bounds() const override;

 private:
  [[nodiscard]] model::MarkPoint mark_of(model::BedPoint point) const;

  const grid::CompensationMap& map_;
  ProgramFrame frame_;
};

/// The default machine of the controller, unless a file states another: the map's machine with its
/// stated, not its calibrated, settings. Empty for a map without a machine.
[[nodiscard]] std::optional<model::Machine> stated_machine(const grid::CompensationMap& map);

/// Half the width of the machine's direction_hysteresis for each chain; zero if it has none.
[[nodiscard]] model::ChainLengths half_play_mm(const model::Machine& machine);

}  // namespace chaintrue::gcode
