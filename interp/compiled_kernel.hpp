// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The arithmetic of CompiledPair, inlined into one function for each instruction set. Internal.
///
/// A cell is four groups (power i of u) of eight numbers (power j of v, surface). With four lanes
/// one vector carries v^0 and v^1 of both surfaces, the other v^2 and v^3; with two lanes each
/// power of v has its own. Both do the same operations in the same order on each number.

#include <cmath>
#include <cstring>

#include "interp/compiled_pair.hpp"

namespace chaintrue::interp::kernel {

typedef double Two __attribute__((vector_size(16)));
typedef double Four __attribute__((vector_size(32)));

// std::vector honours alignas(64) in C++17, yet nothing here depends on it.
typedef double LooseTwo __attribute__((vector_size(16), aligned(8), may_alias));
typedef double LooseFour __attribute__((vector_size(32), aligned(8), may_alias));

#define CHAINTRUE_INLINE [[gnu::always_inline]] inline

struct Place {
  double u;
  double v;
  const double* cell;
};

CHAINTRUE_INLINE Place locate(const CompiledPair::Grid& g, double x, double y) {
  const double u = (x - g.x_min) * g.inverse_step_x;
  const double v = (y - g.y_min) * g.inverse_step_y;
  // One maximum, one minimum each: nested conditionals become branches, which are mispredicted near
  // the edges of a small table.
  const double u_low = u > 0.0 ? u : 0.0;
  const double v_low = v > 0.0 ? v : 0.0;
  const double u_cell = u_low < g.last_cell_x ? u_low : g.last_cell_x;
  const double v_cell = v_low < g.last_cell_y ? v_low : g.last_cell_y;
  const auto i = static_cast<int>(u_cell);
  const auto j = static_cast<int>(v_cell);
  return {u - i, v - j, g.cells + j * g.row + i * 32};
}

CHAINTRUE_INLINE void store(const Two& pair, std::array<double, 2>& out) {
  std::memcpy(out.data(), &pair, sizeof(pair));
}

// A polynomial in u and its derivative by Horner's rule.
template <class Lanes>
struct Horner {
  Lanes value;
  Lanes slope;
};

template <class Lanes, class Loose>
CHAINTRUE_INLINE void horner(const double* c, const Lanes& u, Horner<Lanes>& out) {
  const Lanes c0 = *reinterpret_cast<const Loose*>(c);
  const Lanes c1 = *reinterpret_cast<const Loose*>(c + 8);
  const Lanes c2 = *reinterpret_cast<const Loose*>(c + 16);
  const Lanes c3 = *reinterpret_cast<const Loose*>(c + 24);
  const Lanes a = c3 * u + c2;
  const Lanes b = a * u + c1;
  out.slope = (c3 * u + a) * u + b;
  out.value = b * u + c0;
}

// f = (p0 + v^2 p2) + v (p1 + v^2 p3);  df/dv = (2 v p2 + 3 v^2 p3) + p1.
struct FourLanes {
  CHAINTRUE_INLINE static void evaluate(const CompiledPair::Grid& g,
                                        double x,
                                        double y,
                                        PairGradient& out) {
    const Place place = locate(g, x, y);
    const double v = place.v;
    const double v2 = v * v;
    const Four u = {place.u, place.u, place.u, place.u};
    Horner<Four> low;
    Horner<Four> high;
    horner<Four, LooseFour>(place.cell, u, low);
    horner<Four, LooseFour>(place.cell + 4, u, high);
    const Four square = {v2, v2, v2, v2};
    const Four slopes = {2.0 * v, 2.0 * v, 3.0 * v2, 3.0 * v2};
    const Four f = low.value + square * high.value;
    const Four f_du = low.slope + square * high.slope;
    const Four f_dv = slopes * high.value;
    const Two vv = {v, v};
    const Two step_x = {g.inverse_step_x, g.inverse_step_x};
    const Two step_y = {g.inverse_step_y, g.inverse_step_y};
    const Two value =
        __builtin_shufflevector(f, f, 0, 1) + vv * __builtin_shufflevector(f, f, 2, 3);
    const Two dx = (__builtin_shufflevector(f_du, f_du, 0, 1) +
                    vv * __builtin_shufflevector(f_du, f_du, 2, 3)) *
                   step_x;
    const Two dy =
        ((__builtin_shufflevector(f_dv, f_dv, 0, 1) + __builtin_shufflevector(f_dv, f_dv, 2, 3)) +
         __builtin_shufflevector(low.value, low.value, 2, 3)) *
        step_y;
    store(value, out.value);
    store(dx, out.dx);
    store(dy, out.dy);
  }
};

struct TwoLanes {
  CHAINTRUE_INLINE static void evaluate(const CompiledPair::Grid& g,
                                        double x,
                                        double y,
                                        PairGradient& out) {
    const Place place = locate(g, x, y);
    const double v = place.v;
    const double v2 = v * v;
    const Two u = {place.u, place.u};
    Horner<Two> p0;
    Horner<Two> p1;
    Horner<Two> p2;
    Horner<Two> p3;
    horner<Two, LooseTwo>(place.cell, u, p0);
    horner<Two, LooseTwo>(place.cell + 2, u, p1);
    horner<Two, LooseTwo>(place.cell + 4, u, p2);
    horner<Two, LooseTwo>(place.cell + 6, u, p3);
    const Two vv = {v, v};
    const Two square = {v2, v2};
    const Two twice = {2.0 * v, 2.0 * v};
    const Two thrice = {3.0 * v2, 3.0 * v2};
    const Two step_x = {g.inverse_step_x, g.inverse_step_x};
    const Two step_y = {g.inverse_step_y, g.inverse_step_y};
    store((p0.value + square * p2.value) + vv * (p1.value + square * p3.value), out.value);
    store(((p0.slope + square * p2.slope) + vv * (p1.slope + square * p3.slope)) * step_x, out.dx);
    store(((twice * p2.value + thrice * p3.value) + p1.value) * step_y, out.dy);
  }
};

template <class Kernel>
CHAINTRUE_INLINE InverseResult invert(const CompiledPair::Grid& g,
                                      const Rectangle& domain,
                                      const std::array<double, 2>& target,
                                      const PlanePoint& hint,
                                      double tolerance) {
  constexpr int kMostEvaluations = 40;
  const double diagonal =
      std::sqrt(domain.width() * domain.width() + domain.height() * domain.height());
  // The error of a Newton step follows step' = C step^2. Before two steps have given C, the
  // curvature of lengths whose radius is an eighth of the domain's diagonal is a safe guess.
  const double curvature = 8.0 / diagonal;
  InverseResult result{hint.x, hint.y, InverseStatus::not_converged, 0};
  double previous = 0.0;
  while (result.evaluations < kMostEvaluations) {
    PairGradient z;
    Kernel::evaluate(g, result.x, result.y, z);
    ++result.evaluations;
    const double r0 = target[0] - z.value[0];
    const double r1 = target[1] - z.value[1];
    const double determinant = z.dx[0] * z.dy[1] - z.dx[1] * z.dy[0];
    const double inverse = 1.0 / determinant;
    double dx = (r0 * z.dy[1] - r1 * z.dy[0]) * inverse;
    double dy = (z.dx[0] * r1 - z.dx[1] * r0) * inverse;
    const double square = dx * dx + dy * dy;
    if (!(square < 1e6 * diagonal * diagonal)) {
      return result;
    }
    double step = std::sqrt(square);
    if (step > 0.5 * diagonal) {
      dx *= 0.5 * diagonal / step;
      dy *= 0.5 * diagonal / step;
      step = 0.5 * diagonal;
    }
    result.x += dx;
    result.y += dy;
    const double rate = previous > 0.0 ? step / (previous * previous) : 0.0;
    if ((rate > curvature ? rate : curvature) * square <= 0.5 * tolerance) {
      result.status =
          domain.contains(result.x, result.y) ? InverseStatus::converged : InverseStatus::outside;
      return result;
    }
    previous = step;
  }
  return result;
}

}  // namespace chaintrue::interp::kernel
