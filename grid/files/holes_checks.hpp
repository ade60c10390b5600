// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Input checks of holes and distances, independent of the file format. Private to grid/files.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "grid/files/measured_entries.hpp"
#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid::files {

/// A distance as a file states it.
struct StatedDistance {
  /// A name, or the hole's number as text.
  std::string from;
  std::string to;
  /// Empty if the line was not filled in or its reading is wrong.
  std::optional<double> distance_mm;
  std::optional<double> sigma_mm;
  /// A value was wrong and is already reported; true before any was read.
  bool is_spoilt = true;
};

/// The places of values in their file, for messages.
struct HolesPlaces {
  std::string holes;
  std::string distances;
  std::function<std::string(std::size_t index)> hole;
  PlaceOf distance;
  input_checks::Written written = input_checks::Written::in_json;
};

/// Missing names become the holes' numbers; names that repeat or equal an edge's are reported.
void check_names(std::vector<Hole>& holes, const HolesPlaces& places, Problems& problems);
/// Reports ends that are neither a hole nor an edge, and distances from a hole to itself.
[[nodiscard]] std::vector<HoleDistance> resolved_distances(
    const std::vector<StatedDistance>& stated,
    const std::vector<Hole>& holes,
    const HolesPlaces& places,
    Problems& problems);
/// Warns of distances that equal the commanded ones exactly.
void warn_of_copies(const MeasuredHoles& set, const HolesPlaces& places, Problems& problems);
/// Units, triangles, a forgotten zero offset of the tape, and too few distances.
/// A doubtful stated offset gives only a warning. Call it only if there are no earlier problems.
void check_holes_together(const MeasuredHoles& set,
                          std::size_t fewest_distances,
                          bool tape_zero_is_stated,
                          const HolesPlaces& places,
                          Problems& problems);

}  // namespace chaintrue::grid::files
