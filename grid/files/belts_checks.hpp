// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What lengths of four belts must be like, whatever file they came from. Private to grid/files.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "grid/belts/measured_belts.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

/// Where things stand in their file.
struct BeltPlaces {
  std::string points;
  std::function<std::string(std::size_t index, std::string_view field)> point;
  std::string machine;
};

/// Inches, orders, readings that stand twice, belts that were pulled where they cannot have been. Call
/// it only when no value was wrong before.
void check_belt_points(const MeasuredBelts& belts, const BeltPlaces& places, Problems& problems);
/// Ends of distances that are none. `distances` is their place in the file.
void check_belt_distances(const MeasuredBelts& belts,
                          const std::string& distances,
                          Problems& problems);
/// Enough places, spread out, that make one frame with each belt under its own name. Of a log that is
/// only imported the first two are said, and do not stop it.
void check_belts_together(const MeasuredBelts& belts,
                          const BeltPlaces& places,
                          BeltsUse use,
                          Problems& problems);

}  // namespace chaintrue::grid::files
