// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/spatial_blocks.hpp"

#include <tuple>

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
  const auto by_x = [&](std::size_t i) {
    return std::tuple(points[i].mark.x_mm, points[i].mark.y_mm, points[i].lengths.left_mm);
  };
  const auto by_y = [&](std::size_t i) {
    return std::tuple(points[i].mark.y_mm, points[i].mark.x_mm, points[i].lengths.left_mm);
  };
  sort(order, ascending(by_x));
  std::vector<Indices> blocks;
  for (auto& column : cut(order, 4)) {
    sort(column, ascending(by_y));
    for (auto& block : cut(column, 2)) {
      sort(block);
      blocks.push_back(std::move(block));
    }
  }
  return blocks;
}

}  // namespace chaintrue::grid
