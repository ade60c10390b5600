// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The page that a V-plotter draws for its test drawing, and the list of what to measure on it.
///
/// \code
///   const TestDrawing drawing = planned_drawing(machine, PlotterFirmware::fluidnc);
///   write("page.gcode", drawing_gcode(drawing));
///   write("sheet.txt", measuring_list(drawing));
/// \endcode
#pragma once

#include <string>

#include "grid/plotter/test_drawing.hpp"

namespace chaintrue::grid {

/// In the controller's coordinates (TestDrawing::pins_middle), millimetres, absolute: a cross at each
/// point, then every line with a bow to measure, from its first cross to its last.
std::string drawing_gcode(const TestDrawing& drawing);

/// For a mural, which is sent a picture: 1 unit is 1 mm, the origin is the left top corner of the
/// drawing area.
std::string drawing_svg(const TestDrawing& drawing);

/// What to measure, a numbered line each with a place for the value, in the order of the measures.
std::string measuring_list(const TestDrawing& drawing);

}  // namespace chaintrue::grid
