// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Centre form, radius form, and the tolerance for rounded words.
#include "tools/gcode/arc_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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
constexpr double kWholeTurnRad = 5e-7;

double distance(PlanePoint a, PlanePoint b) {
  return std::hypot(a.first_mm - b.first_mm, a.second_mm - b.second_mm);
}

/// In the program's unit.
std::string in_units(double mm, const ArcRequest& request) {
  return fmt::format(
      "{:.4f} {}", mm / request.mm_per_unit, request.mm_per_unit == 1.0 ? "mm" : "inch");
}

/// I belongs to X, J to Y, K to Z.
char centre_word(char axis) { return static_cast<char>(axis - 'x' + 'i'); }

PlanePoint by_radius(const ArcRequest& request, const Block& block) {
  const double radius = block.value('r') * request.mm_per_unit;
  const bool inches = request.mm_per_unit != 1.0;
  const double tolerance = inches ? kRadiusTolerance_inch * kInchMm : kRadiusToleranceMm;
  const double dx = request.end.first_mm - request.start.first_mm;
  const double dy = request.end.second_mm - request.start.second_mm;
  const double half_chord = 0.5 * std::hypot(dx, dy);
  if (half_chord == 0.0) {
    refuse(bad_arc,
           block.place('r'),
           "the arc ends where it starts, which a radius cannot describe; a full circle "
           "needs its centre");
  }
  double magnitude = std::fabs(radius);
  if (half_chord - magnitude > tolerance) {
    refuse(bad_arc,
           block.place('r'),
           "the radius {} is too small: the arc's ends are {} apart",
           in_units(magnitude, request),
           in_units(2.0 * half_chord, request));
  }
  magnitude = half_chord / magnitude > 1.0 - kTiny ? half_chord : magnitude;
  const double to_centre =
      std::sqrt(std::max(0.0, (magnitude - half_chord) * (magnitude + half_chord)));
  // The short arc has its centre to the right of a clockwise chord; a negative radius selects the
  // long arc.
  const bool right = (request.turns < 0) == (radius > 0.0);
  const double side = right ? -1.0 : 1.0;
  const double length = 2.0 * half_chord;
  return PlanePoint{
      0.5 * (request.start.first_mm + request.end.first_mm) - side * to_centre * dy / length,
      0.5 * (request.start.second_mm + request.end.second_mm) + side * to_centre * dx / length};
}

PlanePoint by_centre(const ArcRequest& request, const Block& block) {
  const char first = centre_word(request.first_axis);
  const char second = centre_word(request.second_axis);
  if (request.absolute_centre && !(block.has(first) && block.has(second))) {
    refuse(bad_arc,
           block,
           "absolute centres (G90.1) need both {} and {}",
           upper(first),
           upper(second));
  }
  const PlanePoint base = request.absolute_centre ? PlanePoint{} : request.start;
  const PlanePoint centre{base.first_mm + block.find(first).value_or(0.0) * request.mm_per_unit,
                          base.second_mm + block.find(second).value_or(0.0) * request.mm_per_unit};
  const bool inches = request.mm_per_unit != 1.0;
  const double radius_tolerance = inches ? kRadiusTolerance_inch * kInchMm : kRadiusToleranceMm;
  const double spiral_tolerance = inches ? kSpiralTolerance_inch * kInchMm : kSpiralToleranceMm;
  const double from_start = distance(centre, request.start);
  const double from_end = distance(centre, request.end);
  if (from_start < radius_tolerance || from_end < radius_tolerance) {
    refuse(bad_arc, block, "the arc's radius is zero: its centre is at its start or end");
  }
  const double difference = std::fabs(from_start - from_end);
  const double relative = difference / std::max(from_start, from_end);
  if (difference > 100.0 * spiral_tolerance ||
      (relative > kSpiralRelativeTolerance && difference > spiral_tolerance)) {
    refuse(bad_arc,
           block,
           "the arc's end is not on its circle: the radius is {} at the start and {} "
           "at the end",
           in_units(from_start, request),
           in_units(from_end, request));
  }
  return centre;
}

double angle(PlanePoint from, PlanePoint to) {
  return std::atan2(to.second_mm - from.second_mm, to.first_mm - from.first_mm);
}

double swept(double from, double to, int turns) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double direction = turns > 0 ? 1.0 : -1.0;
  double sweep = direction * (to - from);
  while (sweep <= kWholeTurnRad) sweep += kTurn;
  while (sweep > kTurn + kWholeTurnRad) sweep -= kTurn;
  return direction * (sweep + (std::abs(turns) - 1) * kTurn);
}

}  // namespace

Circle circle_of(const ArcRequest& request, const Block& block) {
  // A zero across the plane has no effect; FreeCAD writes it with every arc.
  const char across = centre_word(request.normal_axis);
  if (block.find(across).value_or(0.0) != 0.0) {
    refuse(
        bad_arc, block.place(across), "{} has no meaning for an arc of this plane", upper(across));
  }
  const bool has_centre =
      block.has(centre_word(request.first_axis)) || block.has(centre_word(request.second_axis));
  if (block.has('r') && has_centre) {
    refuse(bad_arc, block, "the arc has both a radius and a centre");
  }
  if (!block.has('r') && !has_centre) {
    refuse(bad_arc, block, "the arc has neither a centre (I, J, K) nor a radius (R)");
  }
  if (!block.has(request.first_axis) && !block.has(request.second_axis) && block.has('r')) {
    refuse(bad_arc, block, "an arc by radius needs an end point");
  }
  const PlanePoint centre = block.has('r') ? by_radius(request, block) : by_centre(request, block);
  const double from = angle(centre, request.start);
  return {centre,
          distance(centre, request.start),
          distance(centre, request.end),
          from,
          swept(from, angle(centre, request.end), request.turns)};
}

}  // namespace chaintrue::gcode
