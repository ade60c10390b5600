// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the tool of a simulated machine goes when a controller runs a program: the controller turns
/// places into chain lengths by its own kinematics, the machine's map turns lengths into places.
#pragma once

#include <optional>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "model/controllers/payout.hpp"
#include "tests/gcode_witness/follower/program_path.hpp"

namespace chaintrue::follower {

struct Workshop {
  const grid::CompensationMap* machine = nullptr;
  const model::ControllerKinematics* controller = nullptr;
  /// The controller keeps places as single precision numbers.
  bool single_precision = false;
  /// FluidNC's WallPlotter cuts a command into pieces of about this length and runs the chains
  /// linearly through each; 0: the tool's command stays on the line.
  double chain_linear_piece_mm = 0.0;
};

/// The tool's places along the joined commands, 4 mm apart at most; empty where the machine or the
/// controller has no answer.
[[nodiscard]] std::optional<std::vector<Place>> tool_path(const Workshop& workshop,
                                                          const std::vector<Place>& commands);

}  // namespace chaintrue::follower
