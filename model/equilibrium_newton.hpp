// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shared by the equilibrium's solvers: Newton's starting point, bounds on a step, the convergence
/// test, and the continuation that replaces a cold start near the edge of the domain. Internal to
/// model/; notation in equilibrium.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/equilibrium.hpp"
#include "model/hanging_body.hpp"
#include "model/inverse_domain.hpp"

namespace chaintrue::model {

inline constexpr int kMaxIterations = 50;
// Newton converges quadratically: the error after a step below these is less than rounding.
inline constexpr double kLengthStepMm = 1e-7;
inline constexpr double kRelativeForceStep = 1e-7;
inline constexpr double kAngleStepRad = 1e-9;

/// A bracket reaches as far from the bit as its corner.
inline DomainLimits limits_of(const EquilibriumConstants& m) {
  return {m.motors,
          m.r,
          m.sg,
          m.rho + std::sqrt(m.half_spacing * m.half_spacing + m.bracket_height * m.bracket_height)};
}

/// Straight tangents carry sled and chains: the starting point of every solution.
inline EquilibriumState straight_start(const EquilibriumConstants& m, BedPoint p) {
  const Attachments a = attachments(m, 0.0);
  const double ul = p.x_mm + a.left_x - m.motors.left.x_mm;
  const double yl = m.motors.left.y_mm - p.y_mm - a.left_y;
  const double ur = m.motors.right.x_mm - p.x_mm - a.right_x;
  const double yr = m.motors.right.y_mm - p.y_mm - a.right_y;
  const double rr = m.r * m.r;
  const double sl = std::sqrt(std::max(ul * ul + yl * yl - rr, 1.0));
  const double sr = std::sqrt(std::max(ur * ur + yr * yr - rr, 1.0));
  const double tan_l = (yl * sl + m.sg * m.r * ul) / (ul * sl - m.sg * m.r * yl);
  const double tan_r = (yr * sr + m.sg * m.r * ur) / (ur * sr - m.sg * m.r * yr);
  const double w = m.chain.weight_n_per_mm;
  const double load = m.W + 0.5 * w * (sl + sr);
  // Next to a bracket's vertical or at the beam the straight line has no equilibrium; Newton starts
  // from a taut chain.
  const double slopes = tan_l > 0.0 && tan_r > 0.0 ? tan_l + tan_r : std::max(tan_l + tan_r, 0.05);
  EquilibriumState q;
  const double least = 1e-3 * load + std::abs(m.f);
  q.h_left = std::max((load + m.f * tan_r) / slopes, least + m.f);
  q.v_left = q.h_left * tan_l - 0.5 * w * sl;
  q.s = {std::max(sl - m.rho, 0.1 * sl), std::max(sr - m.rho, 0.1 * sr)};
  return q;
}

/// Applies a Newton step, shortened where a tension or a length would fall below a tenth of itself.
template <bool kRotates>
bool advance(const EquilibriumConstants& m, const EquilibriumStep& step, EquilibriumState& q) {
  const double h_right = q.h_left - m.f;
  double share = 1.0;
  const auto keep = [&share](double value, double change) {
    if (value + share * change < 0.1 * value) share = -0.9 * value / change;
  };
  keep(q.h_left, step.h_left);
  keep(h_right, step.h_left);
  keep(q.s.left, step.s.left);
  keep(q.s.right, step.s.right);
  if constexpr (kRotates) {
    constexpr double kMaxTurn = 0.3;  // rad: beyond it the bracket's moment is not nearly linear
    if (std::abs(share * step.psi) > kMaxTurn) share = kMaxTurn / std::abs(step.psi);
    q.psi += share * step.psi;
  }
  q.h_left += share * step.h_left;
  q.v_left += share * step.v_left;
  q.s.left += share * step.s.left;
  q.s.right += share * step.s.right;
  const double least_h = std::min(q.h_left, q.h_left - m.f);
  return share == 1.0 && std::abs(step.s.left) + std::abs(step.s.right) < kLengthStepMm &&
         std::abs(step.h_left) < kRelativeForceStep * least_h &&
         std::abs(step.v_left) < kRelativeForceStep * (m.W + std::abs(q.v_left)) &&
         std::abs(step.psi) < kAngleStepRad;
}

/// Continuation from below the beam's middle to the point: the branch of solutions with taut chains.
/// \param start  State(BedPoint): the cold start
/// \param converge int(BedPoint, State&): iterations, or 0
template <class State, class Start, class Converge>
int converge_by_continuation(
    const EquilibriumConstants& m, BedPoint p, State& q, Start start, Converge converge) {
  const MotorPosition &l = m.motors.left, &r = m.motors.right;
  const BedPoint middle{0.5 * (l.x_mm + r.x_mm),
                        std::min(p.y_mm, 0.5 * (l.y_mm + r.y_mm) - 0.2 * (r.x_mm - l.x_mm))};
  q = start(middle);
  return hanging::follow(q, [&](double share, State& state) {
    return converge(BedPoint{middle.x_mm + share * (p.x_mm - middle.x_mm),
                             middle.y_mm + share * (p.y_mm - middle.y_mm)},
                    state);
  });
}

/// The likeliest reason why Newton does not converge for a point inside the domain.
inline PoseReason why_not_converged(const EquilibriumConstants& m, BedPoint p) {
  const double u = std::min(p.x_mm - m.motors.left.x_mm, m.motors.right.x_mm - p.x_mm);
  if (u - m.half_spacing <= m.sg * m.r) return PoseReason::outside_verticals;
  return m.f != 0.0 ? PoseReason::slack : PoseReason::not_converged;
}

}  // namespace chaintrue::model
