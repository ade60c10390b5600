// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the settings of V-plotters have in common, and those of Marlin. Private to grid/files.
#pragma once

#include <string>

#include "grid/files/setting_reader.hpp"
#include "grid/plotter/found_plotter.hpp"

namespace chaintrue::grid::files {

inline constexpr Range kPositive{"", 1e-6, 1e6};
inline constexpr const char* kSaysWhatHangs = "describes where the pen hangs";

/// The settings of most controllers do not say what hangs on the cords.
void warn_of_gondola(const PlotterMachine& machine, Problems& problems);

/// Reads M665 and M92 from a log, or the settings from a Configuration.h.
SetPlotter plotter_of_marlin(const std::string& text, Problems& problems);

}  // namespace chaintrue::grid::files
