// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The Frechet distance of two polygonal lines: both are traversed from beginning to end, never
/// backwards.
///
/// H. Alt, M. Godau, Computing the Frechet distance between two polygonal curves, International
/// Journal of Computational Geometry and Applications 5 (1995), 75-91: the free-space diagram, here
/// restricted to reachable cells, so that the cost for near paths is proportional to their lengths.
#pragma once

#include <vector>

#include "tests/gcode_witness/follower/program_path.hpp"

namespace chaintrue::follower {

/// Whether the distance is at most this. Exact up to rounding.
bool within(const std::vector<Place>& a, const std::vector<Place>& b, double distance_mm);

/// The distance to within a part in 500 of itself, or most_mm where it is larger.
double path_distance_mm(const std::vector<Place>& a, const std::vector<Place>& b, double most_mm);

}  // namespace chaintrue::follower
