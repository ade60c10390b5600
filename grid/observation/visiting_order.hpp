// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Orders in which marks in lines are visited: line by line from a corner.
///
/// \code
///   for (const VisitingOrder& order : line_by_line_orders()) {
///     const auto visit = visit_numbers(grid.points, order);   // a number a point, from 0
///   }
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid {

/// Line by line.
struct VisitingOrder {
  bool rows = true;         ///< lines are rows; else columns
  bool serpentine = false;  ///< every second line the other way
  bool from_right = false;  ///< the first mark is on the right
  bool from_below = false;  ///< the first mark is below
  bool operator==(const VisitingOrder&) const = default;
};

/// All sixteen.
std::vector<VisitingOrder> line_by_line_orders();

/// The number of each point's visit, from 0, in the order of `points`; marks measured again (within
/// kRepeatDistanceMm of an earlier point) come last, in that order. Fails with a description of the
/// expected marks if they are not in such lines: to a quarter of the usual spacing, two marks a
/// line on average.
[[nodiscard]] tl::expected<std::vector<int>, std::string> visit_numbers(
    const std::vector<MeasuredPoint>& points, const VisitingOrder& order);

/// "row by row, in alternating directions, from the bottom right".
std::string in_words(const VisitingOrder& order);

}  // namespace chaintrue::grid
