// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_drawing files: the page that a V-plotter drew, and its measurements. Unknown keys are
/// errors, except "comment". Same drawing, same bytes.
///
/// \code
///   write_whole_file("drawing.json", write_blank_drawing(planned_drawing(set)));
///   const TestDrawing drawing = parse_drawing(text, "drawing.json");   // once it is filled in
/// \endcode
#pragma once

#include <string>

#include "grid/files/input_error.hpp"
#include "grid/plotter/test_drawing.hpp"

namespace chaintrue::grid::files {

/// Measures without a value are left out. `file` is the name used in messages. \throws InputError
/// with every problem.
TestDrawing parse_drawing(const std::string& text, const std::string& file);
/// \throws std::logic_error where a number is not finite.
std::string write_drawing(const TestDrawing& drawing);
/// With a null in place of every value, to be filled in.
std::string write_blank_drawing(const TestDrawing& drawing);

}  // namespace chaintrue::grid::files
