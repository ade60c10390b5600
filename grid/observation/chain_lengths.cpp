// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/chain_lengths.hpp"

#include <cmath>

namespace chaintrue::grid::observation {

const Kind chain_lengths{"chain_lengths", "point", "points", "point", true};

Eigen::Matrix2d covariance_of(const PointNoise& noise, const Eigen::Matrix2d& by_mark) {
  return std::pow(noise.length_mm, 2) * Eigen::Matrix2d::Identity() +
         std::pow(noise.position_mm, 2) * by_mark * by_mark.transpose();
}

std::string ChainLengthReadings::untestable(const model::effects::Effect& effect,
                                            model::effects::EffectSide /*side*/) const {
  const bool needs_order = effect.needs == model::effects::DataNeed::order;
  return needs_order && !ordered_ ? "the order in which the points were visited is not known" : "";
}

}  // namespace chaintrue::grid::observation
