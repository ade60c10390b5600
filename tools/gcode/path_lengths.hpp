// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chain lengths along a program's path: at the end of every move, and between, no further apart
/// than requested; at least eight per turn.
#pragma once

#include <functional>

#include "tools/gcode/compensator.hpp"

namespace chaintrue::gcode {

struct PathLengths {
  std::size_t line = 0;
  MoveKind kind = MoveKind::rapid;
  Point place;  ///< on the sheet, mm
  grid::LengthsAnswer answer;  ///< the first two are paid out
  double feed_mm_per_min = 0.0;  ///< 0 for rapids
};

/// Writes the lengths at each point; points off the map become problems of `findings` instead, one
/// for each line of the program.
[[nodiscard]] Result<ProgramSummary> path_lengths(
    LineSource& source,
    const Dialect& dialect,
    const grid::LengthMap& map,
    double every_mm,
    const std::function<void(const PathLengths&)>& write,
    Findings& findings);

}  // namespace chaintrue::gcode
