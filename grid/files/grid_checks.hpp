// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Input checks of a grid's points, independent of the file format. Private to grid/files.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grid/files/measured_entries.hpp"
#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::files {

/// Points this near count as repeats, so a set that is no wider than this has one row only.
inline constexpr double kRepeatDistanceMm = 25.0;
/// The fewest points for a map; they must cover an area.
inline constexpr std::size_t kFewestPoints = 8;

/// A point of a file, before the points are checked together.
struct EnteredPoint {
  MeasuredPoint point;
  /// A value of this point was wrong and is already reported.
  bool is_spoilt = false;
  /// Point of a sheet to fill in that has not been read yet.
  bool is_blank = false;
};

/// The places of points in their file, for messages.
struct PointPlaces {
  /// The points as a whole: "/points", or the header's line.
  std::string all;
  PlaceOf of;
  input_checks::Written written = input_checks::Written::in_json;
};

/// Rows that equal another in every digit are counted once, with a warning; `places` are then those
/// of the others. Applied only to lengths written to a hundredth of a millimetre or finer, and to
/// rows without a visit number.
void count_copies_once(std::vector<EnteredPoint>& points, PointPlaces& places, Problems& problems);

/// Warns of points whose readings equal their commands exactly.
void warn_of_copies(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems);

/// Checks the points together: enough of them, spread over an area, left and right not swapped, in
/// mm. Call it only if no value had a problem.
void check_points_together(const MeasuredGrid& grid, std::size_t fewest_points,
                           const PointPlaces& places, Problems& problems);
/// Warns of points within 25 mm of each other whose readings differ by more than the noise and the
/// distance between them allow. The allowed change is the machine model's if the grid has a
/// machine, otherwise the distance itself.
void warn_of_repeats_that_disagree(const MeasuredGrid& grid, const PointPlaces& places,
                                   Problems& problems);

}  // namespace chaintrue::grid::files
