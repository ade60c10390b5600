// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A V-plotter: two cords (or toothed belts) from the wall to a gondola that carries a pen. Data only;
/// the equilibrium is in plotter_statics.hpp.
///
/// Frame: the origin is midway between the two points on the wall that the cords come from (pins, or
/// the axles of pulleys); x to the right and level, y up, mm.
///
/// Sources of the kinds and of the defaults: nikivanov/mural, KinematicModel.md and src/movement.h (a
/// body with the motors in it); bdring/FluidNC, Kinematics/WallPlotter.cpp, and MarlinFirmware/Marlin,
/// module/polargraph.cpp (a point, motors on the wall).
///
/// \code
///   PlotterMachine machine = mural(1500.0);
///   machine.zero_mm = {40.0, 40.0};
///   for (const MachineProblem& p : problems_of(machine)) say(p.parameter, p.value, p.expected);
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "model/coordinates.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {

/// The location of the motors, with the pulleys or spools that count.
enum class MotorPlace { wall, gondola };
std::string_view name(MotorPlace place);

/// The hanging body. With `spacing_mm` 0 both cords end at the pen and the body cannot tilt.
struct Gondola {
  /// Between the points where the cords hold the body: axles of its pulleys, or eyelets.
  double spacing_mm = 0.0;
  /// From the middle between those points, when the body hangs level.
  double pen_below_mm = 0.0;
  double pen_right_mm = 0.0;
  double mass_below_mm = 0.0;
  double mass_right_mm = 0.0;
  double mass_kg = 0.3;
  /// How much farther off the wall the cords' ends at the gondola are than those at the wall.
  double standoff_mm = 0.0;
};

struct Cord {
  double mass_kg_per_m = 0.0;
  /// Strain per newton of tension, on unstretched length; 0: inextensible.
  double compliance_per_n = 0.0;
  /// The length that a motor loses in one slip: a tooth of the belt, or a full step of a spool.
  double tooth_mm = 2.0;
};

/// The area of allowed commands.
struct DrawingArea {
  double left_mm = -400.0;
  double right_mm = 400.0;
  double top_mm = -300.0;
  double bottom_mm = -1100.0;
};

/// One sigma of each stated setting.
struct PlotterUncertainty {
  double pin_spacing_mm = 3.0;
  double pin_rise_mm = 3.0;
  /// For a homing screw, or a cord hung by eye.
  double zero_mm = 10.0;
  /// One sigma of a pulley's effective diameter.
  double scale_mm_per_m = 3.0;
};

struct PlotterMachine {
  std::string name = "V-plotter";
  double pin_spacing_mm = 1200.0;
  double pin_rise_mm = 0.0;  ///< right over left
  MotorPlace motors = MotorPlace::wall;
  Feed feed = Feed::over_top;
  /// Radius of the cord's line on its pulley; 0: straight to the pin or the axle.
  double pulley_radius_mm = 0.0;
  Gondola gondola;
  Cord cord;
  /// A length as the controller counts it is the cord's own times 1 + scale / 1000, plus zero.
  ChainLengths zero_mm;
  ChainLengths scale_mm_per_m;
  DrawingArea area;
  PlotterUncertainty uncertainty;
};

/// The mural bot with its pins this far apart and its firmware's constants; its drawing area is the
/// firmware's, a fifth of the pins' spacing in from each side and below.
PlotterMachine mural(double pin_spacing_mm);

inline bool is_point(const Gondola& gondola) { return gondola.spacing_mm == 0.0; }

/// All reasons why a machine is invalid; empty when it is valid. The ranges contain every real
/// machine.
[[nodiscard]] std::vector<MachineProblem> problems_of(const PlotterMachine& machine);

}  // namespace chaintrue::model

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::PlotterMachine;
}  // namespace chaintrue
