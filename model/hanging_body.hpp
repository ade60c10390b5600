// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A body that hangs on two heavy elastic lines: Newton on the equations of its equilibrium, and the
/// derivatives of the solution by the implicit function theorem. Internal to model/; the equations
/// are those of chain_equations.hpp or of plotter/plotter_equations.hpp.
///
/// Equations are a function of Unknowns<T>, T a Dual, that returns as many left sides, all 0 in
/// equilibrium. Nothing allocates or throws.
///
/// \code
///   Unknowns<double> q = straight_start();
///   const auto equations = [&](const Unknowns<Dual<kUnknowns>>& at) { return residual(m, at); };
///   if (converge(equations, {weight_n, side_n}, q) == 0) return not_converged();
/// \endcode
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "model/catenary.hpp"
#include "model/dual.hpp"

namespace chaintrue::model {

/// Pull of the left line on the body, across and up; free length of each line, unstretched; pull of
/// each out of the plane; the body's turn in it.
enum Unknown { kH, kV, kSLeft, kSRight, kNLeft, kNRight, kTurn, kUnknowns };
template <class T>
using Unknowns = std::array<T, kUnknowns>;

/// The body's weight, and H_left - H_right.
struct BodyForces {
  double weight_n = 0.0;
  double side_n = 0.0;
};

/// atanh(z)/z with its derivatives.
inline double ratio_of(double z) { return atanh_ratio(z); }
template <int N>
Dual<N> ratio_of(const Dual<N>& z) {
  return z.chained(atanh_ratio(z.value), atanh_ratio_slope(z.value));
}

namespace hanging {

template <int N>
using Slopes = Eigen::Matrix<double, kUnknowns, N>;

/// d(left sides)/d(what they have derivatives by).
template <int N>
Slopes<N> slopes_of(const Unknowns<Dual<N>>& left) {
  Slopes<N> slopes;
  for (int i = 0; i < kUnknowns; ++i) {
    for (int j = 0; j < N; ++j)
      slopes(i, j) = left[static_cast<std::size_t>(i)].d[static_cast<std::size_t>(j)];
  }
  return slopes;
}

/// Numbers without derivatives.
template <int N>
Unknowns<Dual<N>> fixed(const Unknowns<double>& q) {
  Unknowns<Dual<N>> result;
  std::copy(q.begin(), q.end(), result.begin());
  return result;
}

/// The left sides with their derivatives by the unknowns.
template <class Equations>
Unknowns<Dual<kUnknowns>> linearised(const Equations& equations, const Unknowns<double>& q) {
  Unknowns<Dual<kUnknowns>> variables;
  for (int i = 0; i < kUnknowns; ++i) {
    const auto at = static_cast<std::size_t>(i);
    variables[at] = Dual<kUnknowns>::variable(q[at], i);
  }
  return equations(variables);
}

inline constexpr int kMostSteps = 60;

inline bool are_finite(const Unknowns<double>& q) {
  return std::all_of(q.begin(), q.end(), [](double value) { return std::isfinite(value); });
}

/// The step, shortened where a pull or a length would fall below a tenth of itself or the body would
/// turn too far for its moment to be nearly linear. \returns whether it was below rounding.
inline bool advance(const BodyForces& body, const Unknowns<double>& step, Unknowns<double>& q) {
  // Newton converges quadratically: after a step below these the error is less than rounding.
  constexpr double kLengthStepMm = 1e-7;
  constexpr double kRelativeForceStep = 1e-7;
  constexpr double kTurnStepRad = 1e-9;
  constexpr double kMostTurnRad = 0.3;
  double share = 1.0;
  const auto keep = [&share](double value, double change) {
    if (value + share * change < 0.1 * value) share = -0.9 * value / change;
  };
  const double slacker = std::min(0.0, -body.side_n);
  keep(q[kH] + slacker, step[kH]);
  keep(q[kSLeft], step[kSLeft]);
  keep(q[kSRight], step[kSRight]);
  if (std::abs(share * step[kTurn]) > kMostTurnRad) share = kMostTurnRad / std::abs(step[kTurn]);
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += share * step[i];
  const auto small = [&](Unknown i, double scale) {
    return std::abs(step[i]) < kRelativeForceStep * scale;
  };
  const double force = body.weight_n + std::abs(q[kH]);
  return share == 1.0 && std::abs(step[kSLeft]) + std::abs(step[kSRight]) < kLengthStepMm &&
         small(kH, q[kH] + slacker) && small(kV, force) && small(kNLeft, force) &&
         small(kNRight, force) && std::abs(step[kTurn]) < kTurnStepRad;
}

/// Newton from `q`. \returns steps, or 0 if it does not converge.
template <class Equations>
int converge(const Equations& equations, const BodyForces& body, Unknowns<double>& q) {
  for (int n = 1; n <= kMostSteps; ++n) {
    const Unknowns<Dual<kUnknowns>> left = linearised(equations, q);
    Slopes<1> value;
    for (int i = 0; i < kUnknowns; ++i) value[i] = left[static_cast<std::size_t>(i)].value;
    Unknowns<double> step;
    Eigen::Map<Slopes<1>>(step.data()) = -slopes_of(left).partialPivLu().solve(value);
    if (!are_finite(step)) return 0;
    if (advance(body, step, q)) return n;
  }
  return 0;
}

/// The unknowns with their derivatives by what `inputs_vary` depends on besides them:
/// -(dF/dq)^-1 dF/d(inputs).
template <int N, class Equations, class InputsVary>
Unknowns<Dual<N>> with_derivatives(const Equations& equations, const InputsVary& inputs_vary,
                                   const Unknowns<double>& q) {
  Unknowns<Dual<N>> result = fixed<N>(q);
  const Slopes<N> moved =
      -slopes_of(linearised(equations, q)).partialPivLu().solve(slopes_of<N>(inputs_vary(result)));
  for (int i = 0; i < kUnknowns; ++i) {
    for (int j = 0; j < N; ++j)
      result[static_cast<std::size_t>(i)].d[static_cast<std::size_t>(j)] = moved(i, j);
  }
  return result;
}

/// Follows solutions in steps that Newton can take, where a cold start finds none.
/// \param converge int(double share, State&): steps to the solution at that share of the way, or 0
/// \returns all steps, or 0 if the end is not reached
template <class State, class Converge>
int follow(State& q, const Converge& converge) {
  constexpr double kShortest = 1e-4;
  int total = converge(0.0, q);
  if (total == 0) return 0;
  double reached = 0.0, stride = 0.25;
  while (reached < 1.0) {
    const double next = std::min(1.0, reached + stride);
    State trial = q;
    const int steps = converge(next, trial);
    total += steps;
    if (steps != 0) {
      q = trial;
      reached = next;
      stride *= 1.5;
    } else if ((stride *= 0.5) < kShortest) {
      return 0;
    }
  }
  return total;
}

}  // namespace hanging
}  // namespace chaintrue::model
