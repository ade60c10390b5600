// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Arcs by the formulas of the firmwares, in their number format.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/gcode/firmware.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

using Visit = std::function<bool(Point)>;

constexpr float kMaslowPi = 3.1415F;
constexpr float kGrblArcToleranceMm = 0.002F;
constexpr int kGrblArcCorrection = 12;
constexpr float kGrblAngleEpsilon = 5e-7F;
/// For an arc that a controller follows itself.
constexpr double kFewestChords = 8.0;

/// The point of the arc's plane at u, v from its centre, as a share of the way to its other end.
Point point_of(const Arc& arc, double u, double v, double share) {
  return in_plane(arc, u, v,
                  arc.start_height_mm + share * (arc.end_height_mm - arc.start_height_mm));
}

/// The angle of the last turn in the arc's direction, with this firmware's rule for a whole turn.
float turned(const Arc& arc, float whole_turn, float epsilon) {
  const auto angle = static_cast<float>(std::fmod(arc.sweep_rad, 2.0 * std::numbers::pi));
  if (arc.sweep_rad < 0.0) return angle >= -epsilon ? angle - whole_turn : angle;
  return angle <= epsilon ? angle + whole_turn : angle;
}

void exact(const Move& move, double bow_mm, const Visit& visit) {
  const double radius = std::max(move.arc->start_radius_mm, move.arc->end_radius_mm);
  const double chords = chords_within(radius, move.arc->sweep_rad, bow_mm, kFewestChords);
  for (double i = 1.0; i <= chords; i += 1.0) {
    if (!visit(at(move, i / chords))) return;
  }
}

void as_maslow(const Move& move, double bow_mm, const Visit& visit) {
  const Arc& arc = *move.arc;
  const double radius = arc.start_radius_mm;
  const float theta = turned(arc, 2.0F * kMaslowPi, 0.0F);
  const double chords = chords_within(radius, theta, bow_mm, kFewestChords);
  for (double i = 1.0; i <= chords; i += 1.0) {
    const double share = i / chords;
    const double angle = arc.start_angle_rad + share * theta;
    if (!visit(point_of(arc, radius * std::cos(angle), radius * std::sin(angle), share))) return;
  }
  visit(move.to);
}

void as_grbl(const Move& move, const Visit& visit) {
  const Arc& arc = *move.arc;
  const auto start = static_cast<float>(arc.start_angle_rad);
  const auto radius = static_cast<float>(arc.start_radius_mm);
  const float sweep = turned(arc, 2.0F * std::numbers::pi_v<float>, kGrblAngleEpsilon);
  // Below half the tolerance the firmware's square root is not a number: the arc becomes its end.
  const float root = kGrblArcToleranceMm * (2.0F * radius - kGrblArcToleranceMm);
  const float chords =
      root > 0.0F ? std::floor(std::fabs(0.5F * sweep * radius) / std::sqrt(root)) : 0.0F;
  const float step = sweep / std::max(1.0F, chords);
  const float twice = 2.0F - step * step;
  const float sine = step * 0.16666667F * (twice + 4.0F);
  const float cosine = 0.5F * twice;
  const float start_u = radius * std::cos(start);
  const float start_v = radius * std::sin(start);
  float u = start_u;
  float v = start_v;
  int since_exact = 0;
  for (float i = 1.0F; i < chords; i += 1.0F) {
    const bool by_small_angle = since_exact < kGrblArcCorrection;
    const float c = by_small_angle ? cosine : std::cos(i * step);
    const float s = by_small_angle ? sine : std::sin(i * step);
    const float from_u = by_small_angle ? u : start_u;
    const float from_v = by_small_angle ? v : start_v;
    u = from_u * c - from_v * s;
    v = from_u * s + from_v * c;
    since_exact = by_small_angle ? since_exact + 1 : 0;
    if (!visit(point_of(arc, u, v, i / chords))) return;
  }
  visit(move.to);
}

}  // namespace

bool cuts_straight(const Firmware& firmware, double radius_mm, double sweep_rad) {
  if (firmware.arcs != ArcRule::maslow) return false;
  const auto radius = static_cast<float>(radius_mm);
  const auto chord = static_cast<float>(2.0 * radius_mm * std::sin(0.5 * sweep_rad));
  const float height = radius - std::sqrt(radius * radius - 0.25F * chord);
  return (std::fabs(height) < 0.01F && sweep_rad < 0.5) || radius > 25400.0F;
}

void for_each_chord(const Firmware& firmware, const Move& arc, double bow_mm,
                    const std::function<bool(Point)>& visit) {
  const double sweep = std::fabs(turned(*arc.arc, 2.0F * kMaslowPi, 0.0F));
  if (cuts_straight(firmware, arc.arc->start_radius_mm, sweep)) {
    visit(arc.to);
    return;
  }
  switch (firmware.arcs) {
    case ArcRule::exact:
      return exact(arc, bow_mm, visit);
    case ArcRule::maslow:
      return as_maslow(arc, bow_mm, visit);
    case ArcRule::grbl:
      return as_grbl(arc, visit);
  }
}

}  // namespace chaintrue::gcode
