// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/plotter.hpp"

#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

using Real = long double;

/// A pose of the gondola: the middle between its cords' points, and its tilt.
struct GondolaPose {
  Real x = 0.0L, y = 0.0L, tilt = 0.0L;
};

/// What the motor of a side (-1 left, +1 right) has paid out.
Real paid_out(const HiddenPlotter& p, const GondolaPose& pose, int side) {
  const Real half = 0.5L * static_cast<Real>(side) * p.spacing_mm;
  const Real u = static_cast<Real>(side) *
                 (0.5L * side * p.pin_spacing_mm - pose.x - half * std::cos(pose.tilt));
  const Real up = 0.5L * side * p.pin_rise_mm - pose.y - half * std::sin(pose.tilt);
  const Real r = p.pulley_radius_mm;
  const Real straight = std::sqrt(u * u + up * up - r * r);
  const Real between_axles = std::atan2(up, u);
  const Real turned = std::asin(r / std::hypot(u, up));
  const Real arc = p.motors_in_gondola
                       ? r * (0.25L * std::numbers::pi_v<Real> -
                              (between_axles - turned - static_cast<Real>(side) * pose.tilt))
                       : r * (between_axles + turned);
  return std::hypot(straight, static_cast<Real>(p.standoff_mm)) + arc;
}

/// Where both of `f` are 0: secants in both unknowns at once, from `at`.
template <class F>
std::array<Real, 2> both_zero(F f, std::array<Real, 2> at, std::array<Real, 2> steps) {
  constexpr int kSteps = 12;  // each doubles the digits
  for (int n = 0; n < kSteps; ++n) {
    const auto here = f(at);
    const auto alongside = f({at[0] + steps[0], at[1]}), beyond = f({at[0], at[1] + steps[1]});
    const Real a = (alongside[0] - here[0]) / steps[0], b = (beyond[0] - here[0]) / steps[1];
    const Real c = (alongside[1] - here[1]) / steps[0], d = (beyond[1] - here[1]) / steps[1];
    const Real det = a * d - b * c;
    at[0] -= (d * here[0] - b * here[1]) / det;
    at[1] -= (a * here[1] - c * here[0]) / det;
  }
  return at;
}

/// At a tilt the pose with both cords as long as given.
GondolaPose gondola_hung(const HiddenPlotter& p, Real left, Real right, Real tilt) {
  const Real pins = p.pin_spacing_mm - p.spacing_mm;
  const Real x = (left * left - right * right) / (2.0L * pins);
  const Real across = x + 0.5L * pins;
  const auto at = both_zero(
      [&](const std::array<Real, 2>& middle) {
        const GondolaPose pose{middle[0], middle[1], tilt};
        return std::array<Real, 2>{paid_out(p, pose, -1) - left, paid_out(p, pose, 1) - right};
      },
      {x, -std::sqrt(left * left - across * across)}, {1e-6L, 1e-6L});
  return {at[0], at[1], tilt};
}

Real mass_height(const HiddenPlotter& p, const GondolaPose& pose) {
  return pose.y + p.mass_right_mm * std::sin(pose.tilt) - p.mass_below_mm * std::cos(pose.tilt);
}

/// A cord of links with the pull (h, v) at the pen's end: the error of its extent.
std::array<Real, 2> shot(const HiddenPlotter& p, Real h, Real v, Real s, int links,
                         std::array<Real, 2> extent) {
  const Real own = s / links;
  for (int k = 0; k < links; ++k) {
    const Real up = v + p.cord_n_per_mm * own * (static_cast<Real>(k) + 0.5L);
    const Real tension = std::hypot(h, up);
    const Real link = own * (1.0L + p.compliance_per_n * tension) / tension;
    extent[0] -= link * h;
    extent[1] -= link * up;
  }
  return extent;
}

struct EndOfCord {
  Real v = 0.0L, s = 0.0L;
};

/// At a horizontal pull the vertical one and the length with which the cord spans the extent.
EndOfCord spanning(const HiddenPlotter& p, Real h, int links, std::array<Real, 2> extent) {
  const Real chord = std::hypot(extent[0], extent[1]);
  const Real v = h * extent[1] / extent[0] - 0.5L * p.cord_n_per_mm * chord;
  const auto end = both_zero(
      [&](const std::array<Real, 2>& at) { return shot(p, h, at[0], at[1], links, extent); },
      {v, chord}, {1e-7L * (std::abs(v) + h), 1e-7L * chord});
  return {end[0], end[1]};
}

/// Where `f`, which grows, passes 0.
template <class F>
Real bisected(F f, Real low, Real high) {
  constexpr int kHalvings = 60;  // of 60 N: to 1e-16 N
  for (int n = 0; n < kHalvings; ++n) {
    const Real middle = 0.5L * (low + high);
    (f(middle) < 0.0L ? low : high) = middle;
  }
  return 0.5L * (low + high);
}

}  // namespace

PenAtRest lowest_pose(const HiddenPlotter& p, double left_mm, double right_mm) {
  Real tilt = 0.0L;
  if (p.spacing_mm > 0.0) {
    constexpr Real kGolden = 0.6180339887498948482L;
    constexpr int kSections = 47;  // of 2 rad: to 4e-10
    Real low = -1.0L, high = 1.0L;
    const auto height = [&](Real t) {
      return mass_height(p, gondola_hung(p, left_mm, right_mm, t));
    };
    Real inner_low = high - kGolden * (high - low), inner_high = low + kGolden * (high - low);
    Real at_low = height(inner_low), at_high = height(inner_high);
    for (int n = 0; n < kSections; ++n) {
      if (at_low < at_high) {
        high = inner_high;
        inner_high = inner_low;
        at_high = at_low;
        inner_low = high - kGolden * (high - low);
        at_low = height(inner_low);
      } else {
        low = inner_low;
        inner_low = inner_high;
        at_low = at_high;
        inner_high = low + kGolden * (high - low);
        at_high = height(inner_high);
      }
    }
    tilt = 0.5L * (low + high);
  }
  const GondolaPose pose = gondola_hung(p, left_mm, right_mm, tilt);
  const Real c = std::cos(tilt), s = std::sin(tilt);
  return {static_cast<double>(pose.x + p.pen_right_mm * c + p.pen_below_mm * s),
          static_cast<double>(pose.y + p.pen_right_mm * s - p.pen_below_mm * c),
          static_cast<double>(tilt)};
}

std::array<double, 2> lengths_of_links(const HiddenPlotter& p, double x_mm, double y_mm,
                                       int links) {
  const std::array<Real, 2> left{x_mm + 0.5L * p.pin_spacing_mm, -0.5L * p.pin_rise_mm - y_mm};
  const std::array<Real, 2> right{0.5L * p.pin_spacing_mm - x_mm, 0.5L * p.pin_rise_mm - y_mm};
  // More pull lifts more.
  const Real h = bisected(
      [&](Real pull) {
        return spanning(p, pull, links, left).v + spanning(p, pull, links, right).v - p.weight_n;
      },
      0.01L * p.weight_n, 50.0L * p.weight_n);
  return {static_cast<double>(spanning(p, h, links, left).s),
          static_cast<double>(spanning(p, h, links, right).s)};
}

}  // namespace chaintrue::generator
