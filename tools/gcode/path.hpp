// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The exact geometry of a move: lines, arcs, helices and the spirals that rounded words make of
/// arcs.
#pragma once

#include "tools/gcode/events.hpp"

namespace chaintrue::gcode {

/// The place at t = 0 .. 1; exactly `from` and `to` at the ends. Lines: constant speed; arcs:
/// constant angular speed.
[[nodiscard]] Point at(const Move& move, double t);

/// Along the way, mm. For spirals with the mean radius: their radii differ by a rounding only.
[[nodiscard]] double length_mm(const Move& move);

[[nodiscard]] double distance_mm(Point a, Point b);

/// The nearest point of the straight piece from a to b: its parameter 0 .. 1.
[[nodiscard]] double nearest_on_line(Point a, Point b, Point p);

[[nodiscard]] Point between(Point a, Point b, double t);

}  // namespace chaintrue::gcode
