// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/spatial_blocks.hpp"

#include <tuple>

#include "grid/plane_vectors.hpp"

namespace chaintrue::grid {
namespace {

/// Cuts `order` into `parts` runs of nearly equal length.
std::vector<Indices> cut(const Indices& order, std::size_t parts) {
  std::vector<Indices> runs;
  for (const std::size_t part : each_below(parts)) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(part * order.size() / parts);
    const auto last =
        order.begin() + static_cast<std::ptrdiff_t>((part + 1) * order.size() / parts);
    if (first != last) runs.emplace_back(first, last);
  }
  return runs;
}

}  // namespace

std::vector<Indices> spatial_blocks(const std::vector<LengthPoint>& points) {
  auto order = numbers_below(points.size());
  const auto along = [&](Index axis) {
    return ascending([&points, axis](std::size_t i) {
      const Vector2d at = vector_of(points[i].mark);
      return std::tuple(at[axis], at[1 - axis], points[i].lengths.left_mm);
    });
  };
  sort(order, along(0));
  std::vector<Indices> blocks;
  for (auto& column : cut(order, 4)) {
    sort(column, along(1));
    for (auto& block : cut(column, 2)) {
      sort(block);
      blocks.push_back(std::move(block));
    }
  }
  return blocks;
}

}  // namespace chaintrue::grid
