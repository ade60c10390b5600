// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of a V-plotter with its controller's settings, for the formats that contain one.
/// Private to grid/files.
#pragma once

#include "grid/files/json_reader.hpp"
#include "grid/plotter/found_plotter.hpp"

namespace chaintrue::grid::files {

/// Includes the checks of model::problems_of, and what the firmware needs of the machine.
[[nodiscard]] Record<SetPlotter> set_plotter_record();

}  // namespace chaintrue::grid::files
