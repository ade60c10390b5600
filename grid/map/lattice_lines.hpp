// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The columns and rows of points on a lattice.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace chaintrue::grid {

/// Points nearer than this to a line of the lattice lie on it: the rounding of written
/// coordinates.
inline constexpr double kOnLineMm = 0.01;

/// The distinct coordinates, rising; of those within kOnLineMm of each other the least.
[[nodiscard]] std::vector<double> lines_of(std::vector<double> coordinates_mm);

/// The line that a coordinate, one of those which made the lines, lies on.
[[nodiscard]] Eigen::Index line_of(const std::vector<double>& lines_mm, double coordinate_mm);

}  // namespace chaintrue::grid
