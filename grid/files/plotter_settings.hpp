// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings of a V-plotter's controller as a plotter, from the file or the lines of its firmware:
///
///   fluidnc      config.yaml with kinematics: WallPlotter:
///   marlin       M665 and M92 as M503 prints them, or Configuration.h (Makelangelo: the same)
///   polargraph   the properties file
///   mural        "top distance: 1500 mm", and if they were changed "effective pulley diameter: 12.69
///                mm" and "homed step offset: 40 mm", a line each
///
/// Missing values are assumed, with a warning for each.
///
/// \code
///   const ReadPlotter read = parse_plotter_settings(text, "config.yaml");
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/plotter/found_plotter.hpp"

namespace chaintrue::grid::files {

struct ReadPlotter {
  KnownPlotter plotter;
  std::vector<Warning> warnings;
};

/// `file` is the name used in messages. \throws InputError with every problem.
ReadPlotter parse_plotter_settings(const std::string& text, const std::string& file);

/// Settings that only a V-plotter has: all of the above but FluidNC's, which may run a router.
bool is_of_a_plotter_alone(const std::string& text);

}  // namespace chaintrue::grid::files
