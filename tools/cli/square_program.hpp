// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The program that cuts, or draws, a test square: metric, absolute, clockwise from its lower left
/// corner, in one pass. Same square, same bytes.
#pragma once

#include <string>

#include "grid/plotter/test_drawing.hpp"
#include "model/square.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

[[nodiscard]] std::string square_program(const SquareTask& task, double depth_mm);
/// For a V-plotter, in its controller's coordinates: one code on a line, the pen by its own
/// commands.
[[nodiscard]] std::string square_program(const SquareTask& task, const grid::SetPlotter& plotter);

}  // namespace chaintrue::cli
