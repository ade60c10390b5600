// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two bicubic splines on the same axes, evaluated together.
///
/// Each cell holds the powers of both bicubics. The values are those of the splines to rounding, also
/// outside the rectangle of the nodes, where the bicubic of the nearest edge cell continues.

#include <cstddef>
#include <span>
#include <vector>

#include "interp/pair_polynomial.hpp"
#include "interp/tensor_spline.hpp"

namespace chaintrue::interp {

/// Immutable, thread safe; only the constructor allocates. Coordinates must be finite.
///
///     const auto axes = std::make_shared<const TensorAxes>(x_nodes, y_nodes);
///     const SplinePair chains({axes, left}, {axes, right});
///     const PairGradient here = chains.at(x, y);
class SplinePair {
 public:
  /// Throws std::invalid_argument unless both are bicubic and share their axes.
  SplinePair(const TensorSpline& first, const TensorSpline& second);

  PairGradient at(double x, double y) const;

 private:
  struct Interval {
    double low;
    double per_length;  // 1 / length
  };
  struct Place {
    std::ptrdiff_t index;  // of the interval: beyond the ends, the nearest one
    double inside;         // from 0 to 1
    double per_length;
  };
  struct Axis {
    explicit Axis(std::span<const double> nodes);
    Place locate(double x) const;
    std::ptrdiff_t search(double x) const;
    double first;
    double last;  // index of the last interval
    double per_mean_length;
    bool even = true;  // all intervals have the mean length
    std::vector<Interval> intervals;
  };

  Axis x_;
  Axis y_;
  std::vector<PairPolynomial> cells_;  // x fastest
};

}  // namespace chaintrue::interp
