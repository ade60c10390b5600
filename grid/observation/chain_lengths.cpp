// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/chain_lengths.hpp"

#include <cmath>

namespace chaintrue::grid::observation {

const Kind chain_lengths{"chain_lengths", "point", "points", "point", true};

Matrix2d covariance_of(const PointNoise& noise, const Matrix2d& by_mark) {
  return std::pow(noise.length_mm, 2) * Matrix2d::Identity() +
         std::pow(noise.position_mm, 2) * by_mark * by_mark.transpose();
}

}  // namespace chaintrue::grid::observation
