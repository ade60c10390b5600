// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points and lengths of moves.
#include "tools/gcode/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::gcode {

std::string in_xy(Point point) { return fmt::format("X{:.3f} Y{:.3f}", point.x_mm, point.y_mm); }

Point between(Point a, Point b, double t) { return a + t * (b - a); }

double distance_mm(Point a, Point b) {
  // Millimetres neither overflow nor underflow when squared; std::hypot is four times slower.
  return std::sqrt(dot(a - b, a - b));
}

double level_mm(Point way) { return std::hypot(way.x_mm, way.y_mm); }

double nearest_on_line(Point a, Point b, Point p) {
  const double squared = dot(b - a, b - a);
  return squared == 0.0 ? 0.0 : std::clamp(dot(b - a, p - a) / squared, 0.0, 1.0);
}

Point in_plane(const Arc& arc, double u, double v, double height_mm) {
  const Point& a = arc.first;
  const Point& b = arc.second;
  const Point normal{a.y_mm * b.z_mm - a.z_mm * b.y_mm, a.z_mm * b.x_mm - a.x_mm * b.z_mm,
                     a.x_mm * b.y_mm - a.y_mm * b.x_mm};
  return arc.centre + u * a + v * b + height_mm * normal;
}

double chords_within(double radius_mm, double sweep_rad, double bow_mm, double fewest) {
  const double turn = 2.0 * std::acos(1.0 - std::min(bow_mm, radius_mm) / radius_mm);
  return std::ceil(std::max(std::fabs(sweep_rad) / turn, fewest));
}

Point at(const Move& move, double t) {
  if (t <= 0.0) return move.from;
  if (t >= 1.0) return move.to;
  if (!move.arc) return between(move.from, move.to, t);
  const Arc& arc = *move.arc;
  const double radius = arc.start_radius_mm + t * (arc.end_radius_mm - arc.start_radius_mm);
  const double angle = arc.start_angle_rad + t * arc.sweep_rad;
  const double height = arc.start_height_mm + t * (arc.end_height_mm - arc.start_height_mm);
  return in_plane(arc, radius * std::cos(angle), radius * std::sin(angle), height);
}

bool stays(const Move& move) {
  return !move.arc && move.from.x_mm == move.to.x_mm && move.from.y_mm == move.to.y_mm;
}

std::vector<double> bounding_places(const Move& move) {
  std::vector<double> places{0.0, 1.0};
  if (!move.arc) return places;
  const Arc& arc = *move.arc;
  for (const auto axis : {&Point::x_mm, &Point::y_mm, &Point::z_mm}) {
    // first cos(a) + second sin(a) is greatest or least at this angle and half turns from it.
    const double angle = std::atan2(arc.second.*axis, arc.first.*axis);
    const double half_turns = (arc.start_angle_rad - angle) / std::numbers::pi;
    const double swept = arc.sweep_rad / std::numbers::pi;
    const double last = std::max(half_turns, half_turns + swept);
    for (double k = std::ceil(std::min(half_turns, half_turns + swept)); k <= last; k += 1.0)
      places.push_back((k - half_turns) / swept);
  }
  return places;
}

double feed_mm_per_min(const Move& move) {
  return move.feed.mode == FeedMode::inverse_time ? length_mm(move) * move.feed.value
                                                  : move.feed.value;
}

double length_mm(const Move& move) {
  if (!move.arc) return distance_mm(move.from, move.to);
  const Arc& arc = *move.arc;
  return std::hypot(0.5 * (arc.start_radius_mm + arc.end_radius_mm) * arc.sweep_rad,
                    arc.end_height_mm - arc.start_height_mm,
                    arc.end_radius_mm - arc.start_radius_mm);
}

}  // namespace chaintrue::gcode
