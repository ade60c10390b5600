// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Codes with which plotters lift their pens and rest their motors, and which LinuxCNC does not
/// know: such a line is passed on unchanged.
///
/// Sources: MarlinFirmware/Marlin, Marlin/src/gcode/gcode.cpp; bdring/FluidNC, FluidNC/src/GCode.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/gcode/events.hpp"
#include "tools/gcode/line_source.hpp"

namespace chaintrue::gcode {

struct PlotterWord {
  Code code;
  std::string words;  ///< " P0 S30"
};

/// Where the line holds such a code and words with plain numbers from `at` on, and nothing besides;
/// "G28 X Y" too.
/// \param homes_itself every G28 is the controller's own; otherwise one with bare letters is.
std::optional<PlotterWord> plotter_word(const CleanLine& line, std::size_t at, bool homes_itself);

/// M0 or M1 with a text for the operator; on a plotter also M117 and M118, which show one.
struct TextLine {
  Code code;
  std::string text;
  std::vector<CommentText> comments;
};
std::optional<TextLine> text_line(std::string_view raw, bool of_plotter);

}  // namespace chaintrue::gcode
