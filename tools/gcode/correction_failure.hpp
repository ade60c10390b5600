// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Why there is no command for where the tool shall be, or no tool for a command.
#pragma once

#include <string_view>

#include "grid/map/length_map.hpp"

namespace chaintrue::gcode {

enum class CorrectionReason {
  outside_map,
  unreachable,  ///< the machine cannot hold the tool there
  not_converged,
  controller,  ///< out of reach of the controller's own kinematics
};
/// A clause: "lies outside the map", ...
[[nodiscard]] std::string_view sentence_of(CorrectionReason reason);
/// Of `unreachable` and `controller` with the cause, where it is known.
using CorrectionFailure = Failure<CorrectionReason>;
[[nodiscard]] CorrectionFailure correction_failure(const grid::MapFailure& failure);
[[nodiscard]] CorrectionFailure out_of_controllers_reach(const model::PoseFailure& why);

}  // namespace chaintrue::gcode
