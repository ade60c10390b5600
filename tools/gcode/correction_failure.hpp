// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Why there is no command for where the tool shall be, or no tool for a command.
#pragma once

#include <optional>
#include <string>

#include "grid/map/length_map.hpp"

namespace chaintrue::gcode {

struct CorrectionFailure {
  enum class Reason {
    outside_map,
    unreachable,  ///< the machine cannot hold the tool there
    not_converged,
    controller,  ///< out of reach of the controller's own kinematics
  };
  using enum Reason;
  CorrectionFailure(Reason why) : reason(why) {}  // NOLINT: most reasons are the whole answer
  CorrectionFailure(Reason why, model::PoseFailure from);
  CorrectionFailure(const grid::MapFailure& failure);  // NOLINT: of the same

  Reason reason;
  /// Of `unreachable` and `controller`, where it is known.
  std::optional<model::MechanismFailure> cause;
  friend bool operator==(const CorrectionFailure&, const CorrectionFailure&) = default;
};
/// A clause: "lies outside the map", ...; with its own cause behind it.
[[nodiscard]] std::string explain(const CorrectionFailure& failure);

}  // namespace chaintrue::gcode
