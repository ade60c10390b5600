// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What holes and distances must be like, whatever file they came from. Private to grid/files.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/problems.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid::files {

/// A distance as a file states it.
struct StatedDistance {
  /// A name, or the hole's number as text.
  std::string from;
  std::string to;
  double distance_mm = 0.0;
  std::optional<double> sigma_mm;
  /// A value was wrong and is reported already.
  bool is_spoilt = false;
  /// Of a sheet to fill in: nothing was read here yet.
  bool is_blank = false;
};

/// Where things stand in their file.
struct HolesPlaces {
  std::string holes;
  std::string distances;
  std::function<std::string(std::size_t index)> hole;
  std::function<std::string(std::size_t index, std::string_view field)> distance;
};

/// Takes the distances out that were left blank, and says which; `places` are then those of the
/// others. \throws InputError where every distance is blank.
void leave_out_blanks(std::vector<StatedDistance>& distances,
                      HolesPlaces& places,
                      Problems& problems);

/// Names that are missing become the holes' numbers; names that repeat, or are an edge's, are
/// reported.
void check_names(std::vector<Hole>& holes, const HolesPlaces& places, Problems& problems);
/// Ends that are no hole and no edge, or the same hole twice, are reported.
[[nodiscard]] std::vector<HoleDistance> resolved_distances(
    const std::vector<StatedDistance>& stated,
    const std::vector<Hole>& holes,
    const HolesPlaces& places,
    Problems& problems);
/// Warns of distances that read exactly as commanded.
void warn_of_copies(const MeasuredHoles& set, const HolesPlaces& places, Problems& problems);
/// Units, triangles, a hook offset that was forgotten, and whether there is enough. An offset that
/// was stated in so many words is only asked about. Call it only when nothing was wrong before.
void check_holes_together(const MeasuredHoles& set,
                          std::size_t fewest_distances,
                          bool hook_is_stated,
                          const HolesPlaces& places,
                          Problems& problems);

}  // namespace chaintrue::grid::files
