// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two surfaces on one uniform table, made for speed: value and gradient of both at a point,
/// batches of points, and the inverse map by Newton's method.
///
/// Each cell holds the power coefficients of both bicubics interleaved, c[i][j][surface] for u^i
/// v^j with u, v in [0, 1]: 256 bytes a cell. The kernels use the compiler's vector extensions and
/// are chosen at start-up (AVX2 or plain x86-64); contraction to fused multiply-add is off, so that
/// every path gives the same bits.
///
/// Outside the rectangle the bicubic of the nearest edge cell continues; `domain` is the rectangle.
/// Coordinates must be finite.

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "interp/surface.hpp"
#include "interp/tensor_spline.hpp"

namespace chaintrue::interp {

/// Values and gradients of the two surfaces at one point.
struct PairGradient {
  std::array<double, 2> value;
  std::array<double, 2> dx;
  std::array<double, 2> dy;
};

struct PlanePoint {
  double x = 0.0;
  double y = 0.0;
};

enum class InverseStatus {
  converged,      ///< the point lies in the table's rectangle
  outside,        ///< converged, but outside it
  not_converged,  ///< no point of the table has these values; x and y have no meaning
};

struct InverseResult {
  double x;
  double y;
  InverseStatus status;
  int evaluations;
};

/// The resolution of a table and its error against the function it was compiled from.
struct TableError {
  double largest_seen = 0.0;  ///< over both surfaces at five points inside every cell
  double bound = 0.0;         ///< 1.25 times that
};

/// Immutable, thread safe; only the constructors allocate.
///
///     auto table = CompiledPair::compile(bed, 100, 50, [&](double x, double y) {
///       return std::array{left(x, y), right(x, y)};
///     });
///     PairGradient here = table.at(x, y);
///     InverseResult there = table.inverse({left, right}, {hint_x, hint_y});
class CompiledPair {
 public:
  using Function = std::function<std::array<double, 2>(double x, double y)>;

  /// Samples `function` at (nx + 1)(ny + 1) points, interpolates them by not-a-knot bicubics and
  /// measures the error at five points inside every cell. Throws std::invalid_argument when a
  /// sample is not finite or the rectangle or the counts are empty.
  [[nodiscard]] static CompiledPair compile(const Rectangle& rectangle,
                                            int nx,
                                            int ny,
                                            const Function& function);

  /// The same two surfaces, exact to rounding. Throws std::invalid_argument unless both have the
  /// same uniform axes.
  [[nodiscard]] static CompiledPair from_splines(const TensorSpline& first,
                                                 const TensorSpline& second);

  [[nodiscard]] PairGradient at(double x, double y) const;
  [[nodiscard]] std::array<double, 2> value(double x, double y) const;

  /// results[k] = at(points[k]). Throws std::invalid_argument when the spans differ in length.
  /// Blocks of about a thousand points keep the results in the cache.
  void at(std::span<const PlanePoint> points, std::span<PairGradient> results) const;

  /// The point whose two values are `target`, from `hint`, to `tolerance` in x and y.
  [[nodiscard]] InverseResult inverse(const std::array<double, 2>& target,
                                      const PlanePoint& hint,
                                      double tolerance = 1e-9) const;
  /// A sequence of targets along a path: each search starts from the result before it, the first
  /// from `hint`.
  void inverse(std::span<const std::array<double, 2>> targets,
               const PlanePoint& hint,
               std::span<InverseResult> results,
               double tolerance = 1e-9) const;

  [[nodiscard]] const Rectangle& domain() const { return rectangle_; }
  [[nodiscard]] int cells_x() const { return nx_; }
  [[nodiscard]] int cells_y() const { return ny_; }
  [[nodiscard]] const TableError& error() const { return error_; }

  /// What a kernel needs; see compiled_kernel.hpp.
  struct Grid {
    double x_min, y_min;
    double inverse_step_x, inverse_step_y;
    double last_cell_x, last_cell_y;
    std::ptrdiff_t row;  ///< doubles from one row of cells to the next
    const double* cells;
  };

 private:
  CompiledPair(const Rectangle& rectangle, int nx, int ny);
  void fill(const TensorSpline& surface, std::size_t which);
  [[nodiscard]] Grid grid() const;

  struct alignas(64) Cell {
    std::array<double, 32> c;
  };
  Rectangle rectangle_;
  int nx_;
  int ny_;
  double inverse_step_x_;
  double inverse_step_y_;
  std::vector<Cell> cells_;
  TableError error_;
};

/// The instruction set the kernels run on: "avx2" or "x86-64".
[[nodiscard]] const char* compiled_pair_instructions();
/// Runs the plain kernels from then on if `plain`; for tests and benchmarks, not thread safe.
void force_plain_instructions(bool plain);

}  // namespace chaintrue::interp
