// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// G2 and G3: the circle that the words describe, by its centre or its radius.
///
/// Tolerances are LinuxCNC 2.9's: centre form, radii may differ by 0.02828 mm (0.002828 inch) or by
/// 0.1 %, whichever is more, but never by a hundred times the former; radius form, the radius may
/// be 0.00127 mm (0.00005 inch) too small.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string_view>

#include "tools/gcode/interpreter.hpp"

namespace chaintrue::gcode {
namespace {

// LinuxCNC src/emc/rs274ngc/interp_internal.hh.
constexpr double kInchMm = 25.4;
constexpr double kRadiusToleranceMm = 0.00127;
constexpr double kRadiusTolerance_inch = 0.00005;
constexpr double kSpiralToleranceMm = 0.02 * std::numbers::sqrt2;
constexpr double kSpiralTolerance_inch = 0.002 * std::numbers::sqrt2;
constexpr double kSpiralRelativeTolerance = 0.001;
/// A half circle by radius: half the chord equals the radius up to rounding.
constexpr double kTiny = 1e-12;
/// An end within this of the start makes a whole turn (grbl's ARC_ANGULAR_TRAVEL_EPSILON).
constexpr double kWholeTurnRad = 5e-7;
/// More turns than this are a typing error.
constexpr double kMostTurns = 1000.0;
/// For the axes X, Y and Z.
constexpr std::string_view kCentreLetters = "ijk";

/// In the arc's plane, in the program's frame, mm: along its first axis, and along its second.
using PlanePoint = std::complex<double>;

/// The words of an arc, and what they depend on.
struct ArcWords {
  const Block& block;
  PlaneAxes plane;
  PlanePoint start;
  PlanePoint end;
  bool clockwise = false;
  bool absolute_centre = false;
  double mm_per_unit = 1.0;

  bool in_inches() const { return mm_per_unit != 1.0; }
  double radius_tolerance_mm() const {
    return in_inches() ? kRadiusTolerance_inch * kInchMm : kRadiusToleranceMm;
  }
  /// In the program's unit.
  std::string in_units(double mm) const {
    return fmt::format("{:.4f} {}", mm / mm_per_unit, in_inches() ? "inch" : "mm");
  }
};

PlanePoint by_radius(const ArcWords& arc) {
  const Place place = arc.block.place('r');
  const double radius = arc.block.value('r') * arc.mm_per_unit;
  const PlanePoint chord = arc.end - arc.start;
  const double half_chord = 0.5 * std::abs(chord);
  if (half_chord == 0.0) {
    refuse(bad_arc, place,
           "the arc ends where it starts, which a radius cannot describe; a full circle "
           "needs its centre");
  }
  double magnitude = std::fabs(radius);
  if (half_chord - magnitude > arc.radius_tolerance_mm()) {
    refuse(bad_arc, place, "the radius {} is too small: the arc's ends are {} apart",
           arc.in_units(magnitude), arc.in_units(2.0 * half_chord));
  }
  magnitude = half_chord / magnitude > 1.0 - kTiny ? half_chord : magnitude;
  const double to_centre =
      std::sqrt(std::max(0.0, (magnitude - half_chord) * (magnitude + half_chord)));
  // The short arc has its centre to the right of a clockwise chord; a negative radius selects the
  // long arc.
  const double side = arc.clockwise == (radius > 0.0) ? -1.0 : 1.0;
  const PlanePoint along = side * to_centre * chord / (2.0 * half_chord);
  return 0.5 * (arc.start + arc.end) + PlanePoint(-along.imag(), along.real());
}

PlanePoint by_centre(const ArcWords& arc) {
  const Block& block = arc.block;
  const char first = kCentreLetters[arc.plane.first];
  const char second = kCentreLetters[arc.plane.second];
  if (arc.absolute_centre && !(block.has(first) && block.has(second))) {
    refuse(bad_arc, block, "absolute centres (G90.1) need both {} and {}", upper(first),
           upper(second));
  }
  const PlanePoint words(block.find(first).value_or(0.0), block.find(second).value_or(0.0));
  const PlanePoint base = arc.absolute_centre ? PlanePoint() : arc.start;
  const PlanePoint centre = base + words * arc.mm_per_unit;
  const double spiral_tolerance =
      arc.in_inches() ? kSpiralTolerance_inch * kInchMm : kSpiralToleranceMm;
  const double from_start = std::abs(centre - arc.start);
  const double from_end = std::abs(centre - arc.end);
  if (std::min(from_start, from_end) < arc.radius_tolerance_mm()) {
    refuse(bad_arc, block, "the arc's radius is zero: its centre is at its start or end");
  }
  const double difference = std::fabs(from_start - from_end);
  const double relative = difference / std::max(from_start, from_end);
  if (difference > 100.0 * spiral_tolerance ||
      (relative > kSpiralRelativeTolerance && difference > spiral_tolerance)) {
    refuse(bad_arc, block,
           "the arc's end is not on its circle: the radius is {} at the start and {} "
           "at the end",
           arc.in_units(from_start), arc.in_units(from_end));
  }
  return centre;
}

/// \throws Refusal (bad_arc)
PlanePoint centre_of(const ArcWords& arc) {
  const Block& block = arc.block;
  // A zero across the plane has no effect; FreeCAD writes it with every arc.
  const char across = kCentreLetters[arc.plane.normal];
  if (block.find(across).value_or(0.0) != 0.0) {
    refuse(bad_arc, block.place(across), "{} has no meaning for an arc of this plane",
           upper(across));
  }
  const bool has_centre =
      block.has(kCentreLetters[arc.plane.first]) || block.has(kCentreLetters[arc.plane.second]);
  const bool has_end =
      block.has(kAxisLetters[arc.plane.first]) || block.has(kAxisLetters[arc.plane.second]);
  const bool has_radius = block.has('r');
  if (has_radius && has_centre) refuse(bad_arc, block, "the arc has both a radius and a centre");
  if (!has_radius && !has_centre) {
    refuse(bad_arc, block, "the arc has neither a centre (I, J, K) nor a radius (R)");
  }
  if (has_radius && !has_end) refuse(bad_arc, block, "an arc by radius needs an end point");
  return has_radius ? by_radius(arc) : by_centre(arc);
}

/// From start to end about the centre, signed like `turns`, the count of started ones.
double swept(double from, double to, int turns) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double direction = turns > 0 ? 1.0 : -1.0;
  double sweep = direction * (to - from);
  while (sweep <= kWholeTurnRad) sweep += kTurn;
  while (sweep > kTurn + kWholeTurnRad) sweep -= kTurn;
  return direction * (sweep + (std::abs(turns) - 1) * kTurn);
}

double turns_of(const Block& block) {
  const double turns = block.find('p').value_or(1.0);
  if (turns < 1.0 || turns > kMostTurns || std::round(turns) != turns) {
    refuse(bad_arc, block.place('p'), "P, the number of turns, must be a whole number from 1 to {}",
           kMostTurns);
  }
  return turns;
}

}  // namespace

void Interpreter::arc(bool clockwise) {
  const double turns = turns_of(block_);
  if (block_.is(g::machine_frame)) refuse(bad_word_value, block_, "G53 needs G0 or G1");
  if (z_unknown_ && modes_.plane != g::plane_xy) {
    refuse(unsupported_code, block_,
           "after probing, G53, G28 or G30 the start of an upright arc (G18, G19) is known only to "
           "the machine");
  }
  const auto machine = target();
  const Axes start = to_program(machine_);
  const Axes end = to_program(machine);
  const PlaneAxes plane = plane_axes(modes_.plane);
  // LinuxCNC reads absolute centres in the program's frame, including offsets.
  const ArcWords words{block_,
                       plane,
                       {start[plane.first], start[plane.second]},
                       {end[plane.first], end[plane.second]},
                       clockwise,
                       modes_.absolute_centres,
                       mm_per_unit()};
  const auto middle = attempt([&] { return centre_of(words); });
  if (!middle) {
    if (!sink_.goes_on_after(middle.error())) throw Refusal(middle.error());
    machine_ = machine;
    return;
  }
  const auto direction = [&](std::size_t axis) {
    const double cosine = frame_.turn.real();
    const double sine = frame_.turn.imag();
    const Point directions[] = {{cosine, sine, 0.0}, {-sine, cosine, 0.0}, {0.0, 0.0, 1.0}};
    return directions[axis];
  };
  Axes centre = start;
  centre[plane.first] = middle->real();
  centre[plane.second] = middle->imag();
  Arc arc;
  arc.centre = on_sheet(to_machine(centre));
  arc.first = direction(plane.first);
  arc.second = direction(plane.second);
  arc.start_radius_mm = std::abs(*middle - words.start);
  arc.end_radius_mm = std::abs(*middle - words.end);
  arc.start_angle_rad = std::arg(words.start - *middle);
  arc.turns = static_cast<int>(clockwise ? -turns : turns);
  arc.sweep_rad = swept(arc.start_angle_rad, std::arg(words.end - *middle), arc.turns);
  arc.end_height_mm = end[plane.normal] - start[plane.normal];
  constexpr double kHalfTurnRad = std::numbers::pi * (1.0 + 1e-6);
  const double sweep = std::fabs(arc.sweep_rad);
  if (sweep < 2.0 * kHalfTurnRad - 1e-3) {
    ++arcs_;
    if (sweep > kHalfTurnRad && long_arcs_++ == 0) first_long_arc_ = block_.line;
  }
  Move move = basic_move(MoveKind::arc, machine);
  move.arc = arc;
  run(move, machine);
}

}  // namespace chaintrue::gcode
