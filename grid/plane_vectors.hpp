// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Positions (of the bed, a sheet, a frame or a tool) and pairs of chain lengths as vectors of the
/// plane, and how far two of them are apart.
///
/// \code
///   const Eigen::Vector2d error = difference(landed, commanded);   // mm
///   if (distance_mm(mark, other) < 25.0) ...
/// \endcode
#pragma once

#include <cmath>

#include "interp/eigen.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

template <class Position>
Vector2d vector_of(const Position& at) {
  return {at.x_mm, at.y_mm};
}
inline Vector2d vector_of(const ChainLengths& lengths) {
  return {lengths.left_mm, lengths.right_mm};
}

/// `a` less `b`.
template <class A, class B>
Vector2d difference(const A& a, const B& b) {
  return vector_of(a) - vector_of(b);
}
template <class A, class B>
double distance_mm(const A& a, const B& b) {
  return std::hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm);
}

// The index of a chain in a pair of rows or numbers: left, right.

constexpr Index row_of(Side side) { return side == Side::left ? 0 : 1; }

}  // namespace chaintrue::grid
