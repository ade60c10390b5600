// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The path of a simulated machine's tool when a controller runs a program: the controller converts
/// positions to chain lengths by its own kinematics, the machine's map converts lengths to
/// positions.
#pragma once

#include <optional>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "model/controllers/payout.hpp"
#include "tests/gcode_witness/follower/program_path.hpp"

namespace chaintrue::follower {

struct Workshop {
  const grid::LengthMap* machine = nullptr;
  const model::ControllerKinematics* controller = nullptr;
  /// The controller keeps positions in single precision.
  bool single_precision = false;
  /// FluidNC's WallPlotter divides a command into pieces of about this length and moves the chains
  /// linearly over each; 0: the command is followed on the line.
  double chain_linear_piece_mm = 0.0;
};

/// The tool's positions along the joined commands, 4 mm apart at most; empty if the machine or the
/// controller fails anywhere.
std::optional<std::vector<Place>> tool_path(const Workshop& workshop,
                                            const std::vector<Place>& commands);

}  // namespace chaintrue::follower
