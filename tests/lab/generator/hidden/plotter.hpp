// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the pen of a V-plotter comes to rest, by two methods that share nothing with the product's
/// equations of force and moment:
///
///   stiff cords without weight   the pose whose centre of mass lies lowest, among those at which both
///                                cords are as long as they were paid out (energy, golden section)
///   heavy elastic cords to a     chains of many straight links, each with its weight on its pins,
///   point                        shot from the point to the wall (links, bisection and secants)
///
/// Cords leave their pulleys over the top. Frame and names as in the machine's file: the origin midway
/// between the pins, x to the right, y up, mm.
#pragma once

#include <array>

namespace chaintrue::generator {

struct HiddenPlotter {
  double pin_spacing_mm = 1200.0;
  double pin_rise_mm = 0.0;
  double pulley_radius_mm = 0.0;
  bool motors_in_gondola = false;
  double spacing_mm = 0.0;
  double pen_below_mm = 0.0, pen_right_mm = 0.0;
  double mass_below_mm = 0.0, mass_right_mm = 0.0;
  double standoff_mm = 0.0;
  double weight_n = 5.0;
  double cord_n_per_mm = 0.0;
  double compliance_per_n = 0.0;
};

struct PenAtRest {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double tilt_rad = 0.0;
};

/// Stiff cords without weight. With a standoff there must be no pulley: the arc of a cord that slants
/// to the wall is not the level one. Accuracy: the tilt at which a height is least is known to the
/// root of its rounding, 1e-8 rad.
PenAtRest lowest_pose(const HiddenPlotter& plotter, double left_mm, double right_mm);

/// Unstretched lengths of cords of `links` links each to a pen that both end at, without pulleys and
/// standoff. The error falls with the square of the links' number.
std::array<double, 2> lengths_of_links(const HiddenPlotter& plotter, double x_mm, double y_mm,
                                       int links);

}  // namespace chaintrue::generator
