// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// FluidNC's config.yaml of a wall plotter: its anchors, and the travel of its axes as the bed.
///
///   kinematics:
///     WallPlotter:
///       left_anchor_x: -1200
///       left_anchor_y: 900
///       right_anchor_x: 1200
///       right_anchor_y: 900
///   axes:
///     x:
///       max_travel_mm: 2000
///     y:
///       max_travel_mm: 1200
///
/// WallPlotter uses straight lines to the anchors, without sprockets, weights and rings: all of
/// these are assumed, with a warning. Its origin is taken as the bed's centre. Only this part of
/// YAML is read: keys by their indentation, and the value after the colon. Source: bdring/FluidNC,
/// src/Kinematics/WallPlotter.cpp.
#pragma once

#include <string>

#include "grid/files/machine_file.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] bool is_fluidnc(const std::string& text);
/// `file` is the name used in messages and, without its folder, the machine's.
/// \throws InputError with every problem of the file.
[[nodiscard]] ReadMachine parse_fluidnc(const std::string& text, const std::string& file);

}  // namespace chaintrue::grid::files
