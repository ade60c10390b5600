// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The equilibrium of a gondola on two cords as equations, a template for doubles and Duals. Internal
/// to model/plotter; plotter_statics.hpp is the interface.
///
/// Notation, for the cord at side s = -1 (left), +1 (right)
///   A       where it comes from: pin, or axle of the pulley on the wall
///   B       where it holds the gondola: Q + s/2 spacing e1
///   Q, t    the middle between both B, and the gondola's tilt, counter-clockwise
///   e1, e2  the gondola's axes, (cos t, sin t) and (-sin t, cos t)
///   P       the pen: Q + pen_right e1 - pen_below e2;  G, the mass, likewise
///   H, V, N pull of the cord on the gondola towards A, up, and to the wall [N]
///   S       unstretched free cord [mm];   w, c  its weight per mm and its compliance
///   a, b    slope of the cord in the wall's plane at the gondola and at the wall, atan2(V, H)
///   r, g    pulley's radius; +1 over the top, -1 off the bottom
///   W, f, p weight of the gondola; force on the pen towards +x, and up
///
/// With T0, T1 the tensions at both ends, V1 = V + w S, F = 2 / (T0 + T1) and z = w S / (T0 + T1) the
/// elastic catenary (catenary.hpp) in the vertical plane of its own chord is
///   s (A - B)_x = S H (F atanh(z)/z + c),   standoff = S N (F atanh(z)/z + c)
///   (A - B)_y   = S (V + w S / 2) (F + c)                                                   (1)
/// where a pulley moves its end of the cord by g r (-s sin, cos) of a or b. On the gondola act
///   V_left + V_right + p = W,   H_left - H_right = f                                        (2)
/// and about Q, with each pull at the end D of its cord less Q,
///   sum (D_x V + D_y H_left, D_x V - D_y H_right) - W G_x + p P_x - f P_y = 0               (3)
/// The cord that is counted is
///   wall     S + r b  or  S + r (pi - b)
///   gondola  S + g r (pi/4 - (a - s t)):  from the tangent point at 45 degrees              (4)
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "model/coordinates.hpp"
#include "model/hanging_body.hpp"

namespace chaintrue::model::plotter {

/// The constants of the equations, with every effect on.
struct Statics {
  double spacing_mm = 0.0;  ///< of the gondola; 0: a point
  double pen_right_mm = 0.0, pen_below_mm = 0.0;
  double mass_right_mm = 0.0, mass_below_mm = 0.0;
  double standoff_mm = 0.0;
  double weight_n = 0.0;
  double side_n = 0.0;  ///< f
  double lift_n = 0.0;  ///< p
  double radius_mm = 0.0;
  double feed_sign = 1.0;  ///< g
  bool motors_in_gondola = false;
  PerSide<ChainMaterial> cord;
  bool is_point() const { return spacing_mm == 0.0; }
};

/// The position of the pen, and the parameters on which the equations depend.
template <class T>
struct Placed {
  T x, y, pin_spacing, pin_rise;
};
inline constexpr int kPlaced = 4;

/// A cord's pull and length.
template <class T>
struct CordLoad {
  T h, v, n, s;
};

template <class T>
CordLoad<T> load_of(const Statics& m, const Unknowns<T>& q, Side side) {
  if (side == Side::left) return {q[kH], q[kV], q[kNLeft], q[kSLeft]};
  return {q[kH] - m.side_n, m.weight_n - m.lift_n - q[kV], q[kNRight], q[kSRight]};
}

template <class T>
struct Offset {
  T x, y;
};

/// Where a cord leaves a pulley, from the axle.
template <class T>
Offset<T> tangent(const Statics& m, bool has_pulley, double s, const T& h, const T& v) {
  using std::sqrt;
  if (!has_pulley || m.radius_mm == 0.0) return {T(0.0), T(0.0)};
  const T per = m.feed_sign * m.radius_mm / sqrt(h * h + v * v);
  return {-s * per * v, per * h};
}

/// B - Q and D - Q.
template <class T>
Offset<T> end_at_gondola(const Statics& m, const CordLoad<T>& load, double s, const T& tilt) {
  using std::cos;
  using std::sin;
  const Offset<T> own = tangent(m, m.motors_in_gondola, s, load.h, load.v);
  if (m.is_point()) return own;
  const double half_mm = 0.5 * s * m.spacing_mm;
  return {half_mm * cos(tilt) + own.x, half_mm * sin(tilt) + own.y};
}

/// The left sides of (1) of one cord: across, up, off the wall.
template <class T>
std::array<T, 3> cord_residual(const Statics& m, const CordLoad<T>& load, const Placed<T>& at,
                               const Offset<T>& middle, const T& tilt, Side side) {
  using std::sqrt;
  const double s = side == Side::left ? -1.0 : 1.0;
  const ChainMaterial& cord = m.cord[side];
  const T v1 = load.v + cord.weight_n_per_mm * load.s;
  const T level = load.h * load.h + load.n * load.n;
  const T sum = sqrt(level + load.v * load.v) + sqrt(level + v1 * v1);
  const T mean = 2.0 / sum;
  const T across = mean * ratio_of(cord.weight_n_per_mm * load.s / sum) + cord.compliance_per_n;
  const Offset<T> end = end_at_gondola(m, load, s, tilt);
  const Offset<T> wall = tangent(m, !m.motors_in_gondola, s, load.h, v1);
  return {
      s * (0.5 * s * at.pin_spacing + wall.x - middle.x - end.x) - load.s * load.h * across,
      0.5 * s * at.pin_rise + wall.y - middle.y - end.y -
          load.s * (load.v + 0.5 * cord.weight_n_per_mm * load.s) * (mean + cord.compliance_per_n),
      load.s * load.n * across - m.standoff_mm};
}

/// A point of the gondola at `right` and `below` from Q, minus Q.
template <class T>
Offset<T> body_point(double right_mm, double below_mm, const T& tilt) {
  using std::cos;
  using std::sin;
  return {right_mm * cos(tilt) + below_mm * sin(tilt), right_mm * sin(tilt) - below_mm * cos(tilt)};
}

/// The left sides of (1) for both cords and of (3); all 0 in equilibrium. For a point, (3) is the
/// tilt.
template <class T>
Unknowns<T> residual(const Statics& m, const Unknowns<T>& q, const Placed<T>& at) {
  const T& tilt = q[kTurn];
  const Offset<T> pen = body_point(m.pen_right_mm, m.pen_below_mm, tilt);
  const Offset<T> middle{at.x - pen.x, at.y - pen.y};
  const CordLoad<T> l = load_of(m, q, Side::left), r = load_of(m, q, Side::right);
  const auto left = cord_residual(m, l, at, middle, tilt, Side::left);
  const auto right = cord_residual(m, r, at, middle, tilt, Side::right);
  T moment = tilt;
  if (!m.is_point()) {
    const Offset<T> dl = end_at_gondola(m, l, -1.0, tilt), dr = end_at_gondola(m, r, 1.0, tilt);
    const Offset<T> mass = body_point(m.mass_right_mm, m.mass_below_mm, tilt);
    moment = dl.x * l.v + dl.y * l.h + dr.x * r.v - dr.y * r.h - m.weight_n * mass.x +
             m.lift_n * pen.x - m.side_n * pen.y;
  }
  return {left[0], left[1], left[2], right[0], right[1], right[2], moment};
}

/// A cord in equilibrium.
template <class T>
struct CordState {
  T length_mm;  ///< (4), unstretched
  T free_mm;    ///< S
  T angle_rad;  ///< b
  T tension_n;  ///< at its motor
};

template <class T>
CordState<T> cord_state(const Statics& m, const Unknowns<T>& q, Side side) {
  using std::atan2;
  using std::sqrt;
  const CordLoad<T> load = load_of(m, q, side);
  const double s = side == Side::left ? -1.0 : 1.0;
  const T v1 = load.v + m.cord[side].weight_n_per_mm * load.s;
  const T angle = atan2(v1, load.h);
  T wrap(0.0);
  if (m.motors_in_gondola) {
    const T in_body = atan2(load.v, load.h) - s * q[kTurn];
    wrap = m.feed_sign * m.radius_mm * (0.25 * std::numbers::pi - in_body);
  } else {
    wrap = m.feed_sign > 0.0 ? m.radius_mm * angle : m.radius_mm * (std::numbers::pi - angle);
  }
  const T v = m.motors_in_gondola ? load.v : v1;
  return {load.s + wrap, load.s, angle, sqrt(load.h * load.h + v * v + load.n * load.n)};
}

}  // namespace chaintrue::model::plotter
