// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/planner_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp {

std::vector<double> chebyshev_lobatto(double low, double high, int count) {
  if (!(low < high) || count < 2) {
    throw std::invalid_argument(
        fmt::format("{} Chebyshev-Lobatto nodes from {} to {}", count, low, high));
  }
  const double middle = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  std::vector<double> nodes(static_cast<std::size_t>(count), middle);
  for (int i = 0; i < count / 2; ++i) {
    // The sine of an angle from the middle is odd to the last bit; the cosine from one end is not.
    const double offset =
        half * std::sin(std::numbers::pi * (count - 1 - 2 * i) / (2.0 * (count - 1)));
    nodes[static_cast<std::size_t>(i)] = middle - offset;
    nodes[static_cast<std::size_t>(count - 1 - i)] = middle + offset;
  }
  nodes.front() = low;
  nodes.back() = high;
  return nodes;
}

GridShape grid_shape(double width, double height, int points) {
  if (!(width > 0.0) || !(height > 0.0) || points < 4) {
    throw std::invalid_argument(
        fmt::format("a grid of {} points over {} x {}", points, width, height));
  }
  const auto badness = [&](const GridShape& s) {
    return std::abs(std::log((width / (s.columns - 1)) / (height / (s.rows - 1))));
  };
  GridShape best{2, 2};
  double best_score = -1e300;
  for (int columns = 2; 2 * columns <= points; ++columns) {
    const GridShape shape{columns, points / columns};
    // Spacings 10 % apart cost as much as 5 % of the points.
    const double used = static_cast<double>(shape.columns * shape.rows) / points;
    const double score = used - 0.5 * badness(shape);
    if (score > best_score) {
      best_score = score;
      best = shape;
    }
  }
  return best;
}

}  // namespace chaintrue::interp
