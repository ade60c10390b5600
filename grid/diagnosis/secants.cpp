// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/secants.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::grid::diagnosis {

double power_of(const Eigen::VectorXd& whole, const Eigen::VectorXd& half) {
  const double ratio = whole.norm() / std::max(half.norm(), 1e-300);
  return std::max(1.0, std::round(std::log2(ratio)));
}

double power_about(const Eigen::VectorXd& whole, const Eigen::VectorXd& nearby) {
  const double ratio = whole.dot(nearby) / whole.squaredNorm();
  return std::clamp(std::log(std::max(ratio, 1e-3)) / std::log(kNearby), 0.2, 4.0);
}

void limit(Regressor& regressor) {
  const model::effects::EffectParameter& size = regressor.cause.effect->parameters.front();
  const double at = regressor.values.front();
  const auto coefficient = [&](double bound) {
    const double ratio = bound / at;
    return ratio < 0.0 ? -std::pow(-ratio, regressor.power) : std::pow(ratio, regressor.power);
  };
  const double a = coefficient(size.lower);
  const double b = coefficient(size.upper);
  regressor.lowest = std::min(a, b);
  regressor.highest = std::max(a, b);
}

}  // namespace chaintrue::grid::diagnosis
