// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/spline_pair.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "interp/require.hpp"

// A point is evaluated with AVX2 where the processor has it; contraction to fused multiply-add is off,
// so both ways give the same bits.
#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define CHAINTRUE_CLONES [[gnu::target_clones("avx2", "default")]]
#else
#define CHAINTRUE_CLONES
#endif

namespace chaintrue::interp {
namespace {

// The splines that do not vanish in a cell.
struct SplinesInCell {
  Index first;
  Matrix4d powers;  // (power, spline)
};

std::vector<SplinesInCell> splines_in_cells(const SplineAxis& axis) {
  // Inside the cell: at its ends, rounding decides between it and the next one.
  const Vector4d places(0.125, 0.375, 0.625, 0.875);
  const Matrix4d to_powers = powers_through(places);
  std::vector<SplinesInCell> cells;
  const auto nodes = axis.nodes();
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    SplinesInCell cell;
    Matrix4d values;
    for (Index k = 0; k < 4; ++k) {
      const SplineSupport s = axis.support(nodes[i] + places[k] * (nodes[i + 1] - nodes[i]));
      require(s.count == 4, "a pair of splines that are not bicubic");
      cell.first = s.first;
      values.row(k) = s.value.head<4>();
    }
    cell.powers = to_powers * values;
    cells.push_back(cell);
  }
  return cells;
}

}  // namespace

Matrix4d powers_through(const Vector4d& places) {
  Matrix4d powers;
  for (int i = 0; i < 4; ++i) powers.col(i) = places.array().pow(i);
  return powers.inverse();
}

SplinePair::Axis::Axis(std::span<const double> nodes)
    : first(nodes.front()),
      last(static_cast<double>(nodes.size() - 2)),
      per_mean_length((last + 1.0) / (nodes.back() - first)) {
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double length = nodes[i + 1] - nodes[i];
    intervals.push_back({nodes[i], 1.0 / length});
    // A point this close to a node may be assigned to the wrong neighbouring interval. The spline is
    // C2 there: the error grows with the third power of the distance and stays below rounding.
    even = even && std::fabs(length * per_mean_length - 1.0) <= 1e-9;
  }
}

SplinePair::SplinePair(const TensorSpline& first, const TensorSpline& second)
    : x_(first.axes().x.nodes()), y_(first.axes().y.nodes()) {
  require(&first.axes() == &second.axes(), "a pair of splines needs both on the same axes");
  const auto along_x = splines_in_cells(first.axes().x);
  cells_.reserve(x_.intervals.size() * y_.intervals.size());
  for (const SplinesInCell& y : splines_in_cells(first.axes().y)) {
    for (const SplinesInCell& x : along_x) {
      PairPolynomial& cell = cells_.emplace_back();
      std::size_t surface = 0;
      for (const TensorSpline* spline : {&first, &second}) {
        const auto c = spline->coefficients().block<4, 4>(x.first, y.first);
        cell.set(surface++, x.powers * c * y.powers.transpose());
      }
    }
  }
}

std::ptrdiff_t SplinePair::Axis::search(double x) const {
  const auto next = std::upper_bound(intervals.begin() + 1, intervals.end(), x,
                                     [](double place, const Interval& i) { return place < i.low; });
  return next - intervals.begin() - 1;
}

inline SplinePair::Place SplinePair::Axis::locate(double x) const {
  // Clamped before it becomes an index: minimum and maximum are instructions, whereas a branch would
  // be mispredicted for random points in a small table.
  const double nearest = std::min(std::max((x - first) * per_mean_length, 0.0), last);
  // Evenly spaced nodes need no search.
  const std::ptrdiff_t index = even ? static_cast<int>(nearest) : search(x);
  const auto [low, per_length] = intervals.data()[index];
  return {index, (x - low) * per_length, per_length};
}

CHAINTRUE_CLONES PairGradient SplinePair::at(double x, double y) const {
  const Place u = x_.locate(x), v = y_.locate(y);
  return cells_.data()[v.index * std::ssize(x_.intervals) + u.index].at(
      u.inside, v.inside, u.per_length, v.per_length);
}

}  // namespace chaintrue::interp
