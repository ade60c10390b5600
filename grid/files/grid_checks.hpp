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
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::files {

/// Points this near count as repeats, so a set that is no wider than this has one row only.
inline constexpr double kRepeatDistanceMm = 25.0;

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
  /// Of a sheet to fill in: nothing was read here yet.
  bool is_blank = false;
};

/// Where points stand in their file.
struct PointPlaces {
  /// The points as a whole: "/points", or the header's line.
  std::string all;
  /// One point, or one field of it: "/points/3", "line 5, column 8".
  std::function<std::string(std::size_t index, std::string_view field)> of;
};

/// Takes the points out that were left blank, and says which; `places` are then those of the others.
/// \throws InputError where every point is blank.
void leave_out_blanks(std::vector<StatedPoint>& points, PointPlaces& places, Problems& problems);

/// Rows that are another in every digit are counted once, and said; `places` are then those of the
/// others. Only of lengths that are written to a hundredth of a millimetre or finer, and of rows that
/// do not say which visit they are.
void count_copies_once(std::vector<StatedPoint>& points, PointPlaces& places, Problems& problems);

/// Warns of points that read exactly as commanded.
void warn_of_copies(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems);

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
