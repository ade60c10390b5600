// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Surfaces with known values, and grids to sample them on.

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Core>

#include "interp/surface.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::interp::truths {

inline constexpr Rectangle kBed = {-1219.2, 1219.2, -609.6, 609.6};

/// Wrap only: a chain over the top of a sprocket of radius 10.1 at (side 1500, 1060), counted from
/// 12 o'clock; alpha + asin(r / d) is the angle of contact. side is -1 (left) or 1 (right).
inline double wrapped_chain(double x, double y, double side) {
  constexpr double kRadius = 10.1;
  const double dx = 1500.0 - side * x;
  const double dy = 1060.0 - y;
  const double d = std::hypot(dx, dy);
  return std::sqrt(d * d - kRadius * kRadius) +
         kRadius * (std::atan2(dy, dx) + std::asin(kRadius / d));
}

/// The example of the first proposal of this method (seeds/001 of the project's history).
inline double proposal(double x, double y) {
  constexpr double kPi = std::numbers::pi;
  return (2.0 * std::cos(kPi * x / 4800.0) - std::sin(kPi * y / 4800.0) + 0.8) * 1000.0;
}

inline std::vector<double> even(double low, double high, int count) {
  std::vector<double> nodes;
  for (int i = 0; i < count; ++i) {
    nodes.push_back(low + (high - low) * i / (count - 1));
  }
  return nodes;
}

template <class Function>
Eigen::MatrixXd sample(const std::vector<double>& x, const std::vector<double>& y, Function f) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(x.size()), static_cast<Eigen::Index>(y.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < y.size(); ++j) {
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = f(x[i], y[j]);
    }
  }
  return values;
}

/// Of a surface, on a lattice over the bed.
template <class Truth>
double largest_error(const Surface& surface, const Truth& truth) {
  const auto off = [&](double x, double y) { return surface.at(x, y).value - truth(x, y); };
  return sample(even(kBed.x_min, kBed.x_max, 241), even(kBed.y_min, kBed.y_max, 121), off)
      .cwiseAbs()
      .maxCoeff();
}

class Random : public testing_support::Random {
 public:
  using testing_support::Random::Random;
  std::vector<double> nodes(int count, double low, double high) {
    std::vector<double> result = {low};
    std::vector<double> steps;
    double sum = 0.0;
    for (int i = 1; i < count; ++i) {
      steps.push_back(uniform(0.3, 1.7));
      sum += steps.back();
    }
    for (const double step : steps) {
      result.push_back(result.back() + (high - low) * step / sum);
    }
    return result;
  }
};

}  // namespace chaintrue::interp::truths
