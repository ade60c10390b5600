// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/tool_displacement.hpp"

#include "grid/plane_vectors.hpp"

#include <cmath>

namespace chaintrue::grid {

MatrixXd displacement_kernel(const std::vector<model::MarkPoint>& from,
                             const std::vector<model::MarkPoint>& to, double reach_mm) {
  MatrixXd kernel(std::ssize(from), std::ssize(to));
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (std::size_t j = 0; j < to.size(); ++j) {
      const double u = std::sqrt(5.0) * distance_mm(from[i], to[j]) / reach_mm;
      kernel(as_index(i), as_index(j)) = (1.0 + u + u * u / 3.0) * std::exp(-u);
    }
  }
  return kernel;
}

}  // namespace chaintrue::grid
