// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The exact geometry of a move: lines, arcs, helices, and the spirals that result from arcs with
/// rounded words.
#pragma once

#include <string>
#include <vector>

#include "tools/gcode/events.hpp"

namespace chaintrue::gcode {

constexpr Point operator+(Point a, Point b) {
  return {a.x_mm + b.x_mm, a.y_mm + b.y_mm, a.z_mm + b.z_mm};
}
constexpr Point operator-(Point a, Point b) {
  return {a.x_mm - b.x_mm, a.y_mm - b.y_mm, a.z_mm - b.z_mm};
}
constexpr Point operator*(double factor, Point a) {
  return {factor * a.x_mm, factor * a.y_mm, factor * a.z_mm};
}
constexpr double dot(Point a, Point b) {
  return a.x_mm * b.x_mm + a.y_mm * b.y_mm + a.z_mm * b.z_mm;
}
/// "X1.000 Y2.000", for messages.
std::string in_xy(Point point);

/// The point at t = 0 .. 1; exactly `from` and `to` at the ends. Lines: constant speed; arcs:
/// constant angular speed.
Point at(const Move& move, double t);

/// u along the arc's first axis, v along its second, from the centre, and the height over its plane.
Point in_plane(const Arc& arc, double u, double v, double height_mm);
/// Number of chords of an arc for this bow, and at least this many.
double chords_within(double radius_mm, double sweep_rad, double bow_mm, double fewest);

/// Whether it is a straight move without X and Y.
bool stays(const Move& move);

/// Where X, Y or Z turns around, and both ends: t = 0 .. 1 of the places that bound the move.
std::vector<double> bounding_places(const Move& move);

/// Length of the path, mm. For spirals with the mean radius: their radii differ only by rounding.
double length_mm(const Move& move);
/// For any feed mode; 0 if none was stated.
double feed_mm_per_min(const Move& move);

double distance_mm(Point a, Point b);
/// The length of its part in X and Y.
double level_mm(Point way);

/// Parameter 0 .. 1 of the nearest point on the straight piece from a to b.
double nearest_on_line(Point a, Point b, Point p);

Point between(Point a, Point b, double t);

}  // namespace chaintrue::gcode
