// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The circle described by the words of a G2 or G3 block.
///
/// Tolerances are LinuxCNC 2.9's: centre form, radii may differ by 0.02828 mm (0.002828 inch) or by
/// 0.1 %, whichever is more, but never by a hundred times the former; radius form, the radius may
/// be 0.00127 mm (0.00005 inch) too small.
#pragma once

#include "tools/gcode/block.hpp"

namespace chaintrue::gcode {

/// A point of the arc's plane, in the program's frame, mm.
struct PlanePoint {
  double first_mm = 0.0;
  double second_mm = 0.0;
};

struct ArcRequest {
  PlanePoint start;
  PlanePoint end;
  char first_axis = 'x';   ///< G18: z
  char second_axis = 'y';  ///< G18: x
  char normal_axis = 'z';
  int turns = 1;  ///< started ones; below zero clockwise
  bool absolute_centre = false;
  double mm_per_unit = 1.0;
};

struct Circle {
  PlanePoint centre;  ///< in the program's frame
  double start_radius_mm = 0.0;
  double end_radius_mm = 0.0;
  double start_angle_rad = 0.0;
  /// From start to end about the centre, signed. An end within 5e-7 rad of the start makes a whole
  /// turn (grbl's ARC_ANGULAR_TRAVEL_EPSILON).
  double sweep_rad = 0.0;
};

/// \throws Refusal (bad_arc)
[[nodiscard]] Circle circle_of(const ArcRequest& request, const Block& block);

}  // namespace chaintrue::gcode
