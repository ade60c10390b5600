// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Nodes along an axis that minimise the error of a polynomial or spline through them.

#include <vector>

namespace chaintrue::interp {

/// `count` >= 2 Chebyshev-Lobatto nodes of [low, high], both ends included: the projections of
/// evenly spaced points of a half circle (L. N. Trefethen, Approximation Theory and Approximation
/// Practice, 2013, chapter 2). Symmetric to the last bit about the middle. Throws
/// std::invalid_argument unless low < high and count >= 2.
std::vector<double> chebyshev_lobatto(double low, double high, int count);

/// Columns and rows for `points` over width by height: columns * rows <= points, both at least 2.
/// The score is the share of the points used minus half the logarithm of the ratio of the two
/// spacings. Throws std::invalid_argument for fewer than 4 points or an empty rectangle.
struct GridShape {
  int columns = 0;
  int rows = 0;
};
GridShape grid_shape(double width, double height, int points);

}  // namespace chaintrue::interp
