// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings to type into a V-plotter's controller after a test drawing, under the
/// controller's own names.
///
///   fluidnc      config.yaml: kinematics/WallPlotter, steps_per_mm of both axes
///   marlin       M92, M665 L R T (Makelangelo: the same firmware), M500
///   polargraph   machine.width, machine.motors.mmPerRev of the properties file
///   mural        top distance, effective pulley diameter, homed step offset
///
/// Only the mural has a zero to set: other controllers get the pen's true starting position by G92.
///
/// \code
///   for (const std::string& line : settings_to_paste(set, machine_found(set, found)))
///     fmt::print("{}\n", line);
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/plotter/found_plotter.hpp"

namespace chaintrue::grid {

/// In the order in which they are typed in.
std::vector<std::string> settings_to_paste(const SetPlotter& set, const PlotterMachine& found);

}  // namespace chaintrue::grid
