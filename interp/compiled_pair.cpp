// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/compiled_pair.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "interp/compiled_kernel.hpp"

namespace chaintrue::interp {
namespace {

using Grid = CompiledPair::Grid;

struct Kernels {
  const char* name;
  void (*one)(const Grid&, double, double, PairGradient&);
  void (*many)(const Grid&, const PlanePoint*, PairGradient*, std::size_t);
  void (*inverse)(const Grid&,
                  const Rectangle&,
                  const std::array<double, 2>&,
                  const PlanePoint&,
                  double,
                  InverseResult&);
};

#define CHAINTRUE_KERNELS(suffix, lanes, attribute)                                        \
  attribute void one_##suffix(const Grid& g, double x, double y, PairGradient& out) {      \
    kernel::lanes::evaluate(g, x, y, out);                                                 \
  }                                                                                        \
  attribute void many_##suffix(                                                            \
      const Grid& g, const PlanePoint* points, PairGradient* results, std::size_t count) { \
    const Grid local = g;                                                                  \
    for (std::size_t k = 0; k < count; ++k) {                                              \
      kernel::lanes::evaluate(local, points[k].x, points[k].y, results[k]);                \
    }                                                                                      \
  }                                                                                        \
  attribute void inverse_##suffix(const Grid& g,                                           \
                                  const Rectangle& domain,                                 \
                                  const std::array<double, 2>& target,                     \
                                  const PlanePoint& hint,                                  \
                                  double tolerance,                                        \
                                  InverseResult& result) {                                 \
    result = kernel::invert<kernel::lanes>(g, domain, target, hint, tolerance);            \
  }

CHAINTRUE_KERNELS(plain, TwoLanes, )
constexpr Kernels kPlain = {"x86-64", one_plain, many_plain, inverse_plain};

#if defined(__x86_64__)
CHAINTRUE_KERNELS(avx2, FourLanes, __attribute__((target("avx2"))))
constexpr Kernels kAvx2 = {"avx2", one_avx2, many_avx2, inverse_avx2};
#endif

const Kernels* best() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) {
    return &kAvx2;
  }
#endif
  return &kPlain;
}

const Kernels* kernels = best();

bool are_equal(std::span<const double> a, std::span<const double> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

bool uniform(std::span<const double> nodes) {
  const auto n = static_cast<double>(nodes.size() - 1);
  const double step = (nodes.back() - nodes.front()) / n;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    // Decimal nodes are off by their rounding; 1e-12 of a step is negligible.
    if (std::abs(nodes[i] - (nodes.front() + step * static_cast<double>(i))) > 1e-12 * step * n) {
      return false;
    }
  }
  return true;
}

// Power coefficients from the values and the (scaled) slopes at the two ends of the unit interval.
std::array<double, 4> powers(double f0, double f1, double d0, double d1) {
  const double rise = f1 - f0;
  return {f0, d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise};
}

std::vector<double> uniform_nodes(double low, double high, int cells) {
  std::vector<double> nodes;
  for (int i = 0; i <= cells; ++i) {
    nodes.push_back(low + (high - low) * i / cells);
  }
  nodes.back() = high;
  return nodes;
}

/// 0 for an empty extent, which the constructor rejects.
double cells_per_unit(int count, double extent) { return extent > 0.0 ? count / extent : 0.0; }

}  // namespace

const char* compiled_pair_instructions() { return kernels->name; }

void force_plain_instructions(bool plain) { kernels = plain ? &kPlain : best(); }

CompiledPair::CompiledPair(const Rectangle& rectangle, int nx, int ny)
    : rectangle_(rectangle),
      nx_(nx),
      ny_(ny),
      inverse_step_x_(cells_per_unit(nx, rectangle.width())),
      inverse_step_y_(cells_per_unit(ny, rectangle.height())) {
  if (nx < 1 || ny < 1 || !(rectangle.width() > 0.0) || !(rectangle.height() > 0.0) ||
      !std::isfinite(inverse_step_x_) || !std::isfinite(inverse_step_y_)) {
    throw std::invalid_argument(fmt::format(
        "a table of {} x {} cells over {} x {}", nx, ny, rectangle.width(), rectangle.height()));
  }
  cells_.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
}

void CompiledPair::fill(const TensorSpline& surface, std::size_t which) {
  const double hx = 1.0 / inverse_step_x_;
  const double hy = 1.0 / inverse_step_y_;
  const double hxy = hx * hy;
  for (int j = 0; j < ny_; ++j) {
    for (int i = 0; i < nx_; ++i) {
      const auto ix = static_cast<std::size_t>(i);
      const auto iy = static_cast<std::size_t>(j);
      const NodeData& a = surface.node(ix, iy);
      const NodeData& b = surface.node(ix + 1, iy);
      const NodeData& c = surface.node(ix, iy + 1);
      const NodeData& d = surface.node(ix + 1, iy + 1);
      // Along x first: powers of u of f and of its y slope at both ends in y.
      const auto f0 = powers(a.f, b.f, hx * a.fx, hx * b.fx);
      const auto f1 = powers(c.f, d.f, hx * c.fx, hx * d.fx);
      const auto s0 = powers(hy * a.fy, hy * b.fy, hxy * a.fxy, hxy * b.fxy);
      const auto s1 = powers(hy * c.fy, hy * d.fy, hxy * c.fxy, hxy * d.fxy);
      auto& cell = cells_[iy * static_cast<std::size_t>(nx_) + ix].c;
      for (std::size_t u = 0; u < 4; ++u) {
        const auto in_v = powers(f0[u], f1[u], s0[u], s1[u]);
        for (std::size_t v = 0; v < 4; ++v) {
          cell[8 * u + 2 * v + which] = in_v[v];
        }
      }
    }
  }
}

CompiledPair CompiledPair::from_splines(const TensorSpline& first, const TensorSpline& second) {
  const SplineAxis& x = first.axes()->x;
  const SplineAxis& y = first.axes()->y;
  const bool same =
      first.axes() == second.axes() || (are_equal(x.nodes(), second.axes()->x.nodes()) &&
                                        are_equal(y.nodes(), second.axes()->y.nodes()));
  if (!same || !uniform(x.nodes()) || !uniform(y.nodes())) {
    throw std::invalid_argument("a table needs both surfaces on the same evenly spaced axes");
  }
  CompiledPair table(
      first.domain(), static_cast<int>(x.size()) - 1, static_cast<int>(y.size()) - 1);
  table.fill(first, 0);
  table.fill(second, 1);
  return table;
}

CompiledPair CompiledPair::compile(const Rectangle& rectangle,
                                   int nx,
                                   int ny,
                                   const Function& function) {
  CompiledPair table(rectangle, nx, ny);
  const auto axes =
      std::make_shared<const TensorAxes>(uniform_nodes(rectangle.x_min, rectangle.x_max, nx),
                                         uniform_nodes(rectangle.y_min, rectangle.y_max, ny));
  std::array<Eigen::MatrixXd, 2> values;
  values.fill(Eigen::MatrixXd(nx + 1, ny + 1));
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const auto z = function(axes->x.nodes()[static_cast<std::size_t>(i)],
                              axes->y.nodes()[static_cast<std::size_t>(j)]);
      values[0](i, j) = z[0];
      values[1](i, j) = z[1];
    }
  }
  table.fill(TensorSpline(axes, values[0]), 0);
  table.fill(TensorSpline(axes, values[1]), 1);

  constexpr std::array<PlanePoint, 5> kProbe = {
      {{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}};
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      for (const PlanePoint& probe : kProbe) {
        const double x = rectangle.x_min + rectangle.width() * (i + probe.x) / nx;
        const double y = rectangle.y_min + rectangle.height() * (j + probe.y) / ny;
        const auto exact = function(x, y);
        const auto ours = table.value(x, y);
        const double off = std::max(std::abs(exact[0] - ours[0]), std::abs(exact[1] - ours[1]));
        if (!std::isfinite(off)) {
          throw std::invalid_argument(
              fmt::format("the surface to be compiled has no value at ({}, {})", x, y));
        }
        table.error_.largest_seen = std::max(table.error_.largest_seen, off);
      }
    }
  }
  table.error_.bound = 1.25 * table.error_.largest_seen;
  return table;
}

CompiledPair::Grid CompiledPair::grid() const {
  return {rectangle_.x_min,
          rectangle_.y_min,
          inverse_step_x_,
          inverse_step_y_,
          static_cast<double>(nx_ - 1),
          static_cast<double>(ny_ - 1),
          static_cast<std::ptrdiff_t>(nx_) * 32,
          cells_.front().c.data()};
}

PairGradient CompiledPair::at(double x, double y) const {
  PairGradient result;
  kernels->one(grid(), x, y, result);
  return result;
}

std::array<double, 2> CompiledPair::value(double x, double y) const { return at(x, y).value; }

void CompiledPair::at(std::span<const PlanePoint> points, std::span<PairGradient> results) const {
  if (points.size() != results.size()) {
    throw std::invalid_argument(
        fmt::format("{} points and room for {} results", points.size(), results.size()));
  }
  kernels->many(grid(), points.data(), results.data(), points.size());
}

InverseResult CompiledPair::inverse(const std::array<double, 2>& target,
                                    const PlanePoint& hint,
                                    double tolerance) const {
  InverseResult result;
  kernels->inverse(grid(), rectangle_, target, hint, tolerance, result);
  return result;
}

void CompiledPair::inverse(std::span<const std::array<double, 2>> targets,
                           const PlanePoint& hint,
                           std::span<InverseResult> results,
                           double tolerance) const {
  if (targets.size() != results.size()) {
    throw std::invalid_argument(
        fmt::format("{} targets and room for {} results", targets.size(), results.size()));
  }
  PlanePoint from = hint;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    results[k] = inverse(targets[k], from, tolerance);
    if (results[k].status != InverseStatus::not_converged) {
      from = {results[k].x, results[k].y};
    }
  }
}

}  // namespace chaintrue::interp
