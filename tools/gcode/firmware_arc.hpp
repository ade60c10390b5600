// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a controller cuts an arc of an uncompensated program.
///
/// Sources:
///
///   ArcRule::maslow  Motion.cpp, arc (MaslowCNC/Firmware and madgrizzle/OpticalFirmware): on the
///                    radius of the start, through an angle that is made of atan2 and 2 x 3.1415,
///                    then to the end; P is not read. One straight line instead where the "chord
///                    height" r - sqrt(r^2 - c/4), c the chord (not squared), is below 0.01 and the
///                    angle below 0.5 rad, or where r is beyond 25400 mm.
///   ArcRule::grbl    MotionControl.cpp, mc_arc (FluidNC, as in grbl 1.1): n = floor(|a| r / 2 /
///                    sqrt(h (2 r - h))) chords, h = arc_tolerance, on the radius of the start; each
///                    turned from the one before by cos = 1 - b^2/2, sin = b (4 + 2 cos)/6 in float,
///                    after every N_ARC_CORRECTION (12) of them exactly; the last goes to the end.
///                    P is an error (36).
#pragma once

#include <functional>

#include "tools/gcode/events.hpp"
#include "tools/gcode/firmware.hpp"

namespace chaintrue::gcode {

/// Whether an arc of this radius and angle (of one turn at most, no sign) becomes a straight line.
[[nodiscard]] bool cuts_straight(const Firmware& firmware, double radius_mm, double sweep_rad);

/// The ends of the straight moves that an arc becomes, in order; the last is the arc's end. Stops if
/// `visit` returns false.
/// \param bow_mm the largest deviation of the chords if the controller follows the arc itself
void for_each_chord(const Firmware& firmware,
                    const Move& arc,
                    double bow_mm,
                    const std::function<bool(Point)>& visit);

}  // namespace chaintrue::gcode
