// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Closed formulas for a chain's length, from the straight line to the one-shot catenary, as
/// templates for doubles and Duals: the steps of the firmwares in double precision with exact pi.
///
/// Notation
///   U, Y  horizontal and vertical distance from the bit to the sprocket's axis (both positive
///         below the beam)
///   d     sqrt(U^2 + Y^2)
///   r     sprocket radius
///   sg    +1 over the top, -1 off the bottom
///   S     straight part, sqrt(d^2 - r^2)
///   a     its angle below the horizontal
///   wrap  chain past 12 o'clock
///   rho   ring radius
///   W     sled weight
///   w     chain weight per mm
///   c     compliance
///   k     sag factor, 1e-12 / mm^2
///   j     as a subscript: the other chain
///
/// Sources: MaslowCNC/Firmware cnc_ctrl_v1/Kinematics.cpp, triangularInverse (tolerance divides
/// since pull request 479); WebControlCNC/WebControl Actions/HoleySimulationKinematics.py (one-shot
/// catenary and mean stretch).
#pragma once

#include <cmath>
#include <type_traits>

#include "model/dual.hpp"

namespace chaintrue::model {

/// The straight tangent from the bit to a sprocket.
template <class T>
struct StraightChain {
  T straight_mm;  ///< S
  T angle_rad;    ///< a
  T wrap_mm;
};

template <class T>
struct FormulaInputs {
  T u_left_mm, y_left_mm, u_right_mm, y_right_mm;  ///< U and Y of the two sides
  T sprocket_radius_mm, ring_radius_mm;
  T sled_weight_n, chain_weight_n_per_mm, compliance_per_n;
  double feed_sign = 1.0;
};

template <class T>
struct FormulaLengths {
  T left_mm, right_mm;
};

template <class T>
StraightChain<T> straight_chain(const T& u, const T& y, const T& r, double feed_sign) {
  using std::atan2;
  using std::sqrt;
  const T s = sqrt(u * u + y * y - r * r);
  // Rotate (U, Y) by the tangent's own angle: the sum of the firmware's two arcsines as one
  // arctangent.
  const T a = atan2(y * s + feed_sign * r * u, u * s - feed_sign * r * y);
  constexpr double kPi = 3.14159265358979323846;
  const T wrap = feed_sign > 0 ? r * a : r * (kPi - a);
  return {s, a, wrap};
}

/// A straight line to the motor's axis.
template <class T>
FormulaLengths<T> straight_lengths(const FormulaInputs<T>& in) {
  using std::sqrt;
  return {sqrt(in.u_left_mm * in.u_left_mm + in.y_left_mm * in.y_left_mm) - in.ring_radius_mm,
          sqrt(in.u_right_mm * in.u_right_mm + in.y_right_mm * in.y_right_mm) - in.ring_radius_mm};
}

/// A straight tangent and the arc on the sprocket.
template <class T>
FormulaLengths<T> wrap_lengths(const FormulaInputs<T>& in) {
  const auto l = straight_chain(in.u_left_mm, in.y_left_mm, in.sprocket_radius_mm, in.feed_sign);
  const auto r = straight_chain(in.u_right_mm, in.y_right_mm, in.sprocket_radius_mm, in.feed_sign);
  return {l.wrap_mm + l.straight_mm - in.ring_radius_mm,
          r.wrap_mm + r.straight_mm - in.ring_radius_mm};
}

/// The firmware's parabola: S (1 + k 1e-12 cos^2 a S^2 (tan a_j cos a + sin a)^2).
template <class T>
T firmware_sagged_mm(const StraightChain<T>& own, const T& other_angle, double sag_correction) {
  using std::cos;
  using std::sin;
  const T ca = cos(own.angle_rad), sa = sin(own.angle_rad);
  const T lever = sin(other_angle) / cos(other_angle) * ca + sa;
  const T& s = own.straight_mm;
  return s * (1.0 + sag_correction * 1e-12 * ca * ca * s * s * lever * lever);
}

/// Firmware tolerances, percent: the straight part is divided by 1 + tolerance / 100.
struct Tolerances {
  double left_percent = 0.0;
  double right_percent = 0.0;
};

template <class T>
FormulaLengths<T> firmware_lengths(const FormulaInputs<T>& in,
                                   double sag_correction,
                                   const Tolerances& tolerance = {}) {
  const auto l = straight_chain(in.u_left_mm, in.y_left_mm, in.sprocket_radius_mm, in.feed_sign);
  const auto r = straight_chain(in.u_right_mm, in.y_right_mm, in.sprocket_radius_mm, in.feed_sign);
  const T sl = firmware_sagged_mm(l, r.angle_rad, sag_correction);
  const T sr = firmware_sagged_mm(r, l.angle_rad, sag_correction);
  return {l.wrap_mm + sl / (1.0 + tolerance.left_percent / 100.0) - in.ring_radius_mm,
          r.wrap_mm + sr / (1.0 + tolerance.right_percent / 100.0) - in.ring_radius_mm};
}

/// sinh(x)/x.
template <class T>
T sinh_ratio(const T& x) {
  const double v = plain(x);
  // Below 1 the series to x^18/19! is exact to the last bit.
  if (std::abs(v) < 1.0) {
    const T q = x * x;
    T sum = 1.0;
    for (int n = 9; n >= 1; --n) sum = 1.0 + q * sum / static_cast<double>(2 * n * (2 * n + 1));
    return sum;
  }
  if constexpr (std::is_same_v<T, double>) {
    return std::sinh(x) / x;
  } else {
    return x.chained(std::sinh(v) / v, (std::cosh(v) - std::sinh(v) / v) / v);
  }
}

/// The one-shot catenary: tensions of straight chains under the sled and half of both chains, the
/// catenary through the chord's ends at that horizontal tension, less the stretch at the mean
/// tension.
template <class T>
FormulaLengths<T> one_shot_lengths(const FormulaInputs<T>& in, const Tolerances& tolerance = {}) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const auto l = straight_chain(in.u_left_mm, in.y_left_mm, in.sprocket_radius_mm, in.feed_sign);
  const auto r = straight_chain(in.u_right_mm, in.y_right_mm, in.sprocket_radius_mm, in.feed_sign);
  const T w = in.chain_weight_n_per_mm;
  const T total = in.sled_weight_n + 0.5 * w * (l.straight_mm + r.straight_mm);
  const T cl = cos(l.angle_rad), cr = cos(r.angle_rad);
  const T per_sine = total / (sin(l.angle_rad) * cr + cl * sin(r.angle_rad));
  const T horizontal = per_sine * cl * cr;
  const auto length = [&](const StraightChain<T>& chain,
                          const T& cosine,
                          const T& tension,
                          double tolerance_percent) {
    const T h = chain.straight_mm * cosine, v = chain.straight_mm * sin(chain.angle_rad);
    const T across = h * sinh_ratio(0.5 * w * h / horizontal);
    return chain.wrap_mm +
           sqrt(across * across + v * v) / (1.0 + tolerance_percent / 100.0) /
               (1.0 + tension * in.compliance_per_n) -
           in.ring_radius_mm;
  };
  return {length(l, cl, per_sine * cr, tolerance.left_percent),
          length(r, cr, per_sine * cl, tolerance.right_percent)};
}

/// The sag factor with which the firmware's parabola is the chain's: 1e12 (w / W)^2 / 24, in 1e-12
/// / mm^2. Gravity and the frame's tilt cancel.
inline double closed_form_sag_correction(double chain_weight_n_per_mm, double sled_weight_n) {
  const double ratio = chain_weight_n_per_mm / sled_weight_n;
  return 1e12 * ratio * ratio / 24.0;
}

}  // namespace chaintrue::model
