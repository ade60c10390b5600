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
T one_shot_mm(const StraightChain<T>& own, const StraightChain<T>& other, const T& sled_weight_n,
              const T& chain_weight_n_per_mm, const T& compliance_per_n) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T& w = chain_weight_n_per_mm;
  const T total = sled_weight_n + 0.5 * w * (own.straight_mm + other.straight_mm);
  const T own_cosine = cos(own.angle_rad), other_cosine = cos(other.angle_rad);
  const T own_sine = sin(own.angle_rad);
  const T per_sine = total / (own_sine * other_cosine + own_cosine * sin(other.angle_rad));
  const T h = own.straight_mm * own_cosine, v = own.straight_mm * own_sine;
  const T across = h * sinh_ratio(0.5 * w * h / (per_sine * own_cosine * other_cosine));
  return sqrt(across * across + v * v) / (1.0 + per_sine * other_cosine * compliance_per_n);
}

/// The sag factor with which the firmware's parabola is the chain's: 1e12 (w / W)^2 / 24, in 1e-12
/// / mm^2. Gravity and the frame's tilt cancel.
inline double closed_form_sag_correction(double chain_weight_n_per_mm, double sled_weight_n) {
  const double ratio = chain_weight_n_per_mm / sled_weight_n;
  return 1e12 * ratio * ratio / 24.0;
}

}  // namespace chaintrue::model
