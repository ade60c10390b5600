// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/lattice_lines.hpp"

#include <algorithm>

#include "grid/containers.hpp"

namespace chaintrue::grid {

std::vector<double> lines_of(std::vector<double> coordinates_mm) {
  sort(coordinates_mm);
  const auto same = [](double a, double b) { return b - a <= kOnLineMm; };
  coordinates_mm.erase(std::unique(coordinates_mm.begin(), coordinates_mm.end(), same),
                       coordinates_mm.end());
  return coordinates_mm;
}

Eigen::Index line_of(const std::vector<double>& lines_mm, double coordinate_mm) {
  return std::lower_bound(lines_mm.begin(), lines_mm.end(), coordinate_mm - kOnLineMm) -
         lines_mm.begin();
}

}  // namespace chaintrue::grid
