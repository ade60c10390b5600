// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Codes with which plotters lift their pens and rest their motors, and which LinuxCNC does not know: a
/// line of one of them is passed on as it is.
///
/// Sources: MarlinFirmware/Marlin, Marlin/src/gcode/gcode.cpp; bdring/FluidNC, FluidNC/src/GCode.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "tools/gcode/clean_line.hpp"

namespace chaintrue::gcode {

/// "M280 P0 S30" where the line holds such a code and words with plain numbers from `at` on, and
/// nothing besides.
[[nodiscard]] std::optional<std::string> plotter_word(const CleanLine& line, std::size_t at);

}  // namespace chaintrue::gcode
