// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two bicubic splines on the same axes, evaluated together: values and gradients at one place, or
/// at many.
///
/// Each cell holds the power coefficients of both bicubics interleaved, c[i][j][surface] for u^i
/// v^j with u, v in [0, 1]: 256 bytes a cell. The values are those of the splines to rounding, also
/// outside the rectangle of the nodes, where the bicubic of the nearest edge cell continues.
/// Batches use AVX2 where the processor has it; contraction to fused multiply-add is off, so both
/// ways give the same bits.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "interp/tensor_spline.hpp"

namespace chaintrue::interp {

/// Values and gradients of the two surfaces at one point.
struct PairGradient {
  std::array<double, 2> value;
  std::array<double, 2> dx;
  std::array<double, 2> dy;
};

/// Immutable, thread safe; only the constructor allocates. Coordinates must be finite.
///
///     const SplinePair chains(left, right);
///     const PairGradient here = chains.at(x, y);
class SplinePair {
 public:
  /// Throws std::invalid_argument unless both have the same axes.
  SplinePair(const TensorSpline& first, const TensorSpline& second);

  [[nodiscard]] PairGradient at(double x, double y) const;
  /// results[k] = at(points[k].x, points[k].y). Throws std::invalid_argument when the spans differ
  /// in length. Blocks of about a thousand points keep the results in the cache.
  void at(std::span<const PlanePoint> points, std::span<PairGradient> results) const;

 private:
  struct Interval {
    double low;
    double per_length;  // 1 / length
  };
  struct Axis {
    explicit Axis(std::span<const double> nodes);
    double first;
    double per_mean_length;
    double last;       // index of the last interval
    bool even = true;  // all intervals have the mean length
    std::vector<Interval> intervals;
  };
  struct alignas(64) Cell {
    std::array<double, 32> c;
  };
  struct Kernel;

  Axis x_;
  Axis y_;
  std::vector<Cell> cells_;  // x fastest
};

}  // namespace chaintrue::interp
