// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From where the tool shall be to what the controller must be told, and back.
///
///   command(p) = controller.command(map.lengths(p) + play)
///   tool(c)    = map.tool(controller.lengths(c))
///
/// play is zero unless a direction_hysteresis was named: half its width, with the sign of the
/// direction in which each chain runs.
#pragma once

#include <tl/expected.hpp>

#include "model/controllers/payout.hpp"
#include "tools/gcode/correction_failure.hpp"
#include "tools/gcode/firmware.hpp"

namespace chaintrue::gcode {

/// Signs of the chains' running directions: +1 paying out, -1 reeling in.
struct ChainDirections {
  int left = 1;
  int right = 1;
  friend bool operator==(const ChainDirections&, const ChainDirections&) = default;
};

/// Half the width of the machine's direction_hysteresis, per chain; zero where it has none.
[[nodiscard]] model::ChainLengths half_play_mm(const model::Machine& machine);

class Corrector {
 public:
  /// Keeps references.
  Corrector(const grid::LengthMap& map,
            const model::ControllerKinematics& kinematics,
            const Firmware& firmware)
      : map_(map), kinematics_(kinematics), firmware_(firmware) {}

  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> command(
      model::BedPoint target) const;
  /// With half the play added in the directions that the chains run.
  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> command(
      model::BedPoint target, model::ChainLengths half_play_mm, ChainDirections directions) const;
  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> tool(
      model::BedPoint command) const;
  [[nodiscard]] tl::expected<model::ChainLengths, CorrectionFailure> paid_out(
      model::BedPoint command) const;

  [[nodiscard]] const grid::LengthMap& map() const { return map_; }
  [[nodiscard]] const model::ControllerKinematics& kinematics() const { return kinematics_; }
  [[nodiscard]] const Firmware& firmware() const { return firmware_; }

  /// The largest second derivative of the correction along any direction, in 1/mm, sampled over the
  /// map's bounds: a straight move of length s bends by at most s^2/8 times this.
  [[nodiscard]] double sampled_curvature_per_mm() const;

 private:
  const grid::LengthMap& map_;
  const model::ControllerKinematics& kinematics_;
  const Firmware& firmware_;
};

}  // namespace chaintrue::gcode
