// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/planner_nodes.hpp"

#include <cmath>
#include <numbers>

#include "interp/require.hpp"

namespace chaintrue::interp {

std::vector<double> chebyshev_lobatto(double low, double high, int count) {
  require(low < high && count >= 2, "{} Chebyshev-Lobatto nodes from {} to {}", count, low, high);
  const double middle = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  std::vector<double> nodes;
  for (int i = 0; i < count; ++i) {
    // The sine of an angle from the middle is odd to the last bit; the cosine from one end is not.
    const double angle = std::numbers::pi * (2 * i - (count - 1)) / (2.0 * (count - 1));
    nodes.push_back(middle + half * std::sin(angle));
  }
  nodes.front() = low;
  nodes.back() = high;
  return nodes;
}

GridShape grid_shape(double width, double height, int points) {
  require(width > 0.0 && height > 0.0 && points >= 4, "a grid of {} points over {} x {}", points,
          width, height);
  GridShape best{2, 2};
  double best_score = -1e300;
  for (int columns = 2; 2 * columns <= points; ++columns) {
    const GridShape shape{columns, points / columns};
    // Spacings 10 % apart cost as much as 5 % of the points.
    const double used = 1.0 * shape.columns * shape.rows / points;
    const double aspect = (width / (columns - 1)) / (height / (shape.rows - 1));
    const double score = used - 0.5 * std::abs(std::log(aspect));
    if (score > best_score) {
      best_score = score;
      best = shape;
    }
  }
  return best;
}

}  // namespace chaintrue::interp
