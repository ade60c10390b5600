// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The interface of every surface z = f(x, y). Units are the caller's: x and y share one (mm
/// throughout chaintrue), z has its own.

namespace chaintrue::interp {

/// f and its gradient at one point. Units: z, z per x, z per y.
struct ValueGradient {
  double value = 0.0;
  double dx = 0.0;
  double dy = 0.0;
};

struct PlanePoint {
  double x = 0.0;
  double y = 0.0;
};

/// A closed rectangle of the plane.
struct Rectangle {
  double x_min = 0.0;
  double x_max = 0.0;
  double y_min = 0.0;
  double y_max = 0.0;

  constexpr bool contains(double x, double y) const {
    return x >= x_min && x <= x_max && y >= y_min && y <= y_max;
  }
  constexpr double width() const { return x_max - x_min; }
  constexpr double height() const { return y_max - y_min; }
};

/// A smooth surface. Implementations are immutable after construction, allocate nothing in `at`,
/// and may be read from any number of threads. Every point of the plane has a value: each class
/// states how it continues outside its domain; whether that value may be used is for the caller to
/// decide.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual ValueGradient at(double x, double y) const = 0;
  /// The rectangle that the data cover.
  virtual Rectangle domain() const = 0;
};

}  // namespace chaintrue::interp
