// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Input checks of lengths of four belts, independent of the file format. Private to grid/files.
#pragma once

#include <string>

#include "grid/belts/measured_belts.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/measured_entries.hpp"

namespace chaintrue::grid::files {

/// The places of values in their file, for messages.
struct BeltPlaces {
  std::string points;
  PlaceOf point;
  std::string machine;
};

/// "tl 1811.99, tr 1790.81, bl 1785.26, br 1807.9".
std::string lengths_in_words(const BeltPoint& point);
/// The machine was read several times at one position without moving: then two readings may be equal to
/// the last digit.
bool holds_repeats(const MeasuredBelts& belts);

/// A place, and the first one with the same four lengths to the last digit.
struct BeltCopy {
  std::size_t point;
  std::size_t first;
};
std::vector<BeltCopy> copies_of(const std::vector<BeltPoint>& points);

/// Checks for inches, orders, readings that occur twice, and belts that cannot have been pulled. Call
/// it only if no value had a problem before.
void check_belt_points(const MeasuredBelts& belts, const BeltPlaces& places, Problems& problems);
/// Checks the ends of distances.
void check_belt_distances(const MeasuredBelts& belts, Problems& problems);
/// Enough positions, spread out, that are consistent with one frame and the belts' names. For a log
/// that is only imported the first two are warnings. True if they are enough for a fit.
bool check_belts_together(const MeasuredBelts& belts, const BeltPlaces& places, BeltsUse use,
                          Problems& problems);

}  // namespace chaintrue::grid::files
