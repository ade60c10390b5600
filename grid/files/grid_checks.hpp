// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the points of a grid must be like, whatever file they came from. Private to grid/files.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/problems.hpp"
#include "grid/measured_grid.hpp"

namespace chaintrue::grid::files {

/// A point as a file states it, before it is known to be whole.
struct StatedPoint {
  double x_mm = 0.0;
  double y_mm = 0.0;
  std::optional<double> left_mm;
  std::optional<double> right_mm;
  std::optional<double> commanded_x_mm;
  std::optional<double> commanded_y_mm;
  std::optional<int> order;
  /// A value of this point was wrong and is reported already.
  bool is_spoilt = false;
};

/// Where points stand in their file.
struct PointPlaces {
  /// The points as a whole: "/points", or the header's line.
  std::string all;
  /// One point, or one field of it: "/points/3", "line 5, column 8".
  std::function<std::string(std::size_t index, std::string_view field)> of;
};

/// Each point by itself has lengths or a command, whole and not both; all have an order, distinct,
/// or none.
[[nodiscard]] std::vector<MeasuredPoint> measured_points(const std::vector<StatedPoint>& stated,
                                                         const PointPlaces& places,
                                                         Problems& problems);
/// The points together: enough of them, spread over an area, left and right where they belong, in
/// mm. Call it only when nothing was wrong with the points' own values.
void check_points_together(const MeasuredGrid& grid,
                           std::size_t fewest_points,
                           const PointPlaces& places,
                           Problems& problems);
/// Warns of points within 25 mm of each other whose readings differ by more than the noise and the
/// way between them allow. The way is the machine model's where the grid has a machine, the
/// distance itself where not.
void warn_of_repeats_that_disagree(const MeasuredGrid& grid,
                                   const PointPlaces& places,
                                   Problems& problems);

}  // namespace chaintrue::grid::files
