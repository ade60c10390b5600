// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command for a position of the tool, and the inverse.
///
///   command(p) = controller.command(map.lengths(p) + play)
///   tool(c)    = map.tool(controller.lengths(c))
///
/// play is half the width of a named direction_hysteresis, with the sign of each chain's direction
/// of motion; zero if none was named.
///
/// A CorrectionFailure states why there is no command for a position, or no tool position for a
/// command.
#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "grid/map/length_map.hpp"
#include "interp/checked_field.hpp"
#include "model/controllers/payout.hpp"
#include "tools/gcode/firmware.hpp"

namespace chaintrue::gcode {

/// The map's reasons, and the controller's.
enum class CorrectionReason {
  outside_map,
  unreachable,  ///< the machine cannot hold the tool there
  not_converged,
  controller,  ///< out of reach of the controller's own kinematics
};
static_assert(static_cast<int>(CorrectionReason::not_converged) ==
              static_cast<int>(grid::MapReason::not_converged));
/// A clause: "is outside the map", ...
std::string_view sentence_of(CorrectionReason reason);
/// For `unreachable` and `controller` with the cause, if known.
using CorrectionFailure = Failure<CorrectionReason>;
template <class T>
using Corrected = tl::expected<T, CorrectionFailure>;
[[nodiscard]] CorrectionFailure correction_failure(const grid::MapFailure& failure);

/// Factor by which a sampled curvature may be too small.
inline constexpr double kCurvatureSafety = 2.0;

/// Signs of the chains' directions of motion: +1 paying out, -1 reeling in.
struct ChainDirections {
  int left = 1;
  int right = 1;
  friend bool operator==(const ChainDirections&, const ChainDirections&) = default;
};

/// Half the width of the machine's direction_hysteresis, per chain; zero if it has none.
model::ChainLengths half_play_mm(const model::Machine& machine);

class Corrector {
 public:
  /// Keeps references.
  Corrector(const grid::LengthMap& map, const model::ControllerKinematics& kinematics,
            const Firmware& firmware)
      : map_(map), kinematics_(kinematics), firmware_(firmware) {}

  /// With half the play added in the chains' directions of motion.
  Corrected<model::BedPoint> command(model::BedPoint target, model::ChainLengths half_play_mm = {},
                                     ChainDirections directions = {}) const;
  Corrected<model::BedPoint> tool(model::BedPoint command) const;
  Corrected<model::ChainLengths> paid_out(model::BedPoint command) const;

  const grid::LengthMap& map() const { return map_; }
  const model::ControllerKinematics& kinematics() const { return kinematics_; }
  const Firmware& firmware() const { return firmware_; }

  /// The largest second derivative of the correction along any direction, in 1/mm, sampled over the
  /// map's bounds: a straight move of length s bows by at most s^2/8 times this.
  double sampled_curvature_per_mm() const;

 private:
  const grid::LengthMap& map_;
  const model::ControllerKinematics& kinematics_;
  const Firmware& firmware_;
};

/// command(p) - p and tool(c) - c of a corrector that outlives them, for tables.
interp::CheckedField::Function offsets_of_command(const Corrector& corrector);
interp::CheckedField::Function offsets_of_tool(const Corrector& corrector);

}  // namespace chaintrue::gcode
