// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/spline_pair.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define CHAINTRUE_CLONES [[gnu::target_clones("avx2", "default")]]
#else
#define CHAINTRUE_CLONES
#endif

namespace chaintrue::interp {
namespace {

// Power coefficients from the values and (scaled) slopes at the ends of the unit interval.
std::array<double, 4> powers(double f0, double f1, double d0, double d1) {
  const double rise = f1 - f0;
  return {f0, d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise};
}

bool are_equal(std::span<const double> a, std::span<const double> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

SplinePair::Axis::Axis(std::span<const double> nodes)
    : first(nodes.front()),
      per_mean_length(static_cast<double>(nodes.size() - 1) / (nodes.back() - nodes.front())),
      last(static_cast<double>(nodes.size() - 2)) {
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    intervals.push_back({nodes[i], 1.0 / (nodes[i + 1] - nodes[i])});
    // Decimal nodes are off by their rounding; 1e-12 of the axis is negligible.
    const double place = (nodes[i] - first) * per_mean_length;
    even = even && std::fabs(place - static_cast<double>(i)) <= 1e-12 * (last + 1.0);
  }
}

SplinePair::SplinePair(const TensorSpline& first, const TensorSpline& second)
    : x_(first.axes()->x.nodes()), y_(first.axes()->y.nodes()) {
  if (!are_equal(first.axes()->x.nodes(), second.axes()->x.nodes()) ||
      !are_equal(first.axes()->y.nodes(), second.axes()->y.nodes())) {
    throw std::invalid_argument("a pair of splines needs both on the same axes");
  }
  const std::size_t columns = x_.intervals.size();
  cells_.resize(columns * y_.intervals.size());
  const TensorSpline* const splines[] = {&first, &second};
  for (std::size_t at = 0; at < 2 * cells_.size(); ++at) {
    const TensorSpline& spline = *splines[at % 2];
    const std::size_t ix = at / 2 % columns;
    const std::size_t iy = at / 2 / columns;
    const double hx = 1.0 / x_.intervals[ix].per_length;
    const double hy = 1.0 / y_.intervals[iy].per_length;
    const NodeData& a = spline.node(ix, iy);
    const NodeData& b = spline.node(ix + 1, iy);
    const NodeData& c = spline.node(ix, iy + 1);
    const NodeData& d = spline.node(ix + 1, iy + 1);
    // Along x first: powers of u of f and of its y slope at both ends in y.
    const auto f0 = powers(a.f, b.f, hx * a.fx, hx * b.fx);
    const auto f1 = powers(c.f, d.f, hx * c.fx, hx * d.fx);
    const auto s0 = powers(hy * a.fy, hy * b.fy, hx * hy * a.fxy, hx * hy * b.fxy);
    const auto s1 = powers(hy * c.fy, hy * d.fy, hx * hy * c.fxy, hx * hy * d.fxy);
    for (std::size_t u = 0; u < 4; ++u) {
      const auto in_v = powers(f0[u], f1[u], s0[u], s1[u]);
      for (std::size_t v = 0; v < 4; ++v) cells_[at / 2].c[8 * u + 2 * v + at % 2] = in_v[v];
    }
  }
}

struct SplinePair::Kernel {
  // The interval (beyond the ends, the nearest one) and the place in it.
  [[gnu::always_inline]] static double locate(const Axis& axis, double x, std::ptrdiff_t& index) {
    // One maximum, one minimum: nested conditionals become branches, which are mispredicted near the
    // edges of a small table.
    const double guess = (x - axis.first) * axis.per_mean_length;
    const double low = guess > 0.0 ? guess : 0.0;
    index = static_cast<int>(low < axis.last ? low : axis.last);
    // Even nodes need no search: comparing with them would be a branch that random places
    // mispredict.
    if (axis.even) return guess - static_cast<double>(index);
    const Interval* const interval = axis.intervals.data();
    while (index > 0 && x < interval[index].low) --index;
    while (index < static_cast<std::ptrdiff_t>(axis.last) && x >= interval[index + 1].low) ++index;
    return (x - interval[index].low) * interval[index].per_length;
  }

  [[gnu::always_inline]] static void evaluate(const SplinePair& pair,
                                              const PlanePoint& point,
                                              PairGradient& out) {
    std::ptrdiff_t i = 0;
    std::ptrdiff_t j = 0;
    const double u = locate(pair.x_, point.x, i);
    const double v = locate(pair.y_, point.y, j);
    const double* const cell =
        pair.cells_.data()[j * static_cast<std::ptrdiff_t>(pair.x_.intervals.size()) + i].c.data();
    // Horner's rule for the polynomial in u of each power of v of both surfaces: eight parallel
    // loops that the compiler vectorises.
    std::array<double, 8> p;
    std::array<double, 8> slope;
    for (std::size_t l = 0; l < 8; ++l) {
      const double a = cell[24 + l] * u + cell[16 + l];
      const double b = a * u + cell[8 + l];
      slope[l] = (cell[24 + l] * u + a) * u + b;
      p[l] = b * u + cell[l];
    }
    const double v2 = v * v;
    const double per_x = pair.x_.intervals.data()[i].per_length;
    const double per_y = pair.y_.intervals.data()[j].per_length;
    for (std::size_t k = 0; k < 2; ++k) {
      out.value[k] = (p[k] + v2 * p[4 + k]) + v * (p[2 + k] + v2 * p[6 + k]);
      out.dx[k] = ((slope[k] + v2 * slope[4 + k]) + v * (slope[2 + k] + v2 * slope[6 + k])) * per_x;
      out.dy[k] = ((2.0 * v * p[4 + k] + 3.0 * v2 * p[6 + k]) + p[2 + k]) * per_y;
    }
  }
};

PairGradient SplinePair::at(double x, double y) const {
  PairGradient result;
  Kernel::evaluate(*this, {x, y}, result);
  return result;
}

CHAINTRUE_CLONES void SplinePair::at(std::span<const PlanePoint> points,
                                     std::span<PairGradient> results) const {
  if (points.size() != results.size()) {
    throw std::invalid_argument(
        fmt::format("{} points and room for {} results", points.size(), results.size()));
  }
  for (std::size_t k = 0; k < points.size(); ++k) Kernel::evaluate(*this, points[k], results[k]);
}

}  // namespace chaintrue::interp
