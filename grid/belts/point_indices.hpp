// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers of points in their file when others were left out by hand: messages and files keep the
/// file's numbers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid {

/// Each point's index in the file, from 0; empty: none was left out.
using PointIndices = std::vector<std::size_t>;

inline std::size_t index_in_file(const PointIndices& indices, std::size_t point) {
  return point < indices.size() ? indices[point] : point;
}
/// "point 3" as the file counts, from 1; an anchor, or a hole.
inline std::string words_of(const BeltEnd& end, const PointIndices& indices) {
  const auto* point = std::get_if<std::size_t>(&end);
  return words_of(point != nullptr ? BeltEnd(index_in_file(indices, *point)) : end);
}

}  // namespace chaintrue::grid
