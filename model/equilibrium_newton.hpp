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

/// A bracket reaches as far from the bit as its corner.
inline DomainLimits limits_of(const EquilibriumConstants& m) {
  return {m.motors, m.r, m.sg,
          m.rho + std::sqrt(m.half_spacing * m.half_spacing + m.bracket_height * m.bracket_height)};
}

/// Straight tangents carry sled and chains: the starting point of every solution.
inline Unknowns<double> straight_start(const EquilibriumConstants& m, BedPoint p) {
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
  Unknowns<double> q{};
  const double least = 1e-3 * load + std::abs(m.f);
  q[kH] = std::max((load + m.f * tan_r) / slopes, least + m.f);
  q[kV] = q[kH] * tan_l - 0.5 * w * sl;
  q[kSLeft] = std::max(sl - m.rho, 0.1 * sl);
  q[kSRight] = std::max(sr - m.rho, 0.1 * sr);
  // Each end carries half of the chain's weight off the sheet.
  const double off_sheet = 0.5 * w * m.sin_tilt / m.cos_tilt;
  q[kNLeft] = -off_sheet * q[kSLeft];
  q[kNRight] = -off_sheet * q[kSRight];
  return q;
}

/// Continuation from below the beam's middle to the point: the branch of solutions with taut chains.
/// \param converge int(BedPoint, Unknowns<double>&): steps, or 0
template <class Converge>
int converge_by_continuation(const EquilibriumConstants& m, BedPoint p, Unknowns<double>& q,
                             const Converge& converge) {
  const MotorPosition &l = m.motors.left, &r = m.motors.right;
  const BedPoint middle{0.5 * (l.x_mm + r.x_mm),
                        std::min(p.y_mm, 0.5 * (l.y_mm + r.y_mm) - 0.2 * (r.x_mm - l.x_mm))};
  q = straight_start(m, middle);
  return hanging::follow(q, [&](double share, Unknowns<double>& at) {
    return converge(BedPoint{middle.x_mm + share * (p.x_mm - middle.x_mm),
                             middle.y_mm + share * (p.y_mm - middle.y_mm)},
                    at);
  });
}

/// From straight chains, or by continuation if that fails. \param converge as above
/// \returns steps, or 0
template <class Converge>
int converge_from_start(const EquilibriumConstants& m, BedPoint p, Unknowns<double>& q,
                        const Converge& converge) {
  q = straight_start(m, p);
  const int steps = converge(p, q);
  return steps != 0 ? steps : converge_by_continuation(m, p, q, converge);
}

/// The likeliest reason why Newton does not converge for a point inside the domain.
inline PoseReason why_not_converged(const EquilibriumConstants& m, BedPoint p) {
  const double u = std::min(p.x_mm - m.motors.left.x_mm, m.motors.right.x_mm - p.x_mm);
  if (u - m.half_spacing <= m.sg * m.r) return PoseReason::outside_verticals;
  return m.f != 0.0 ? PoseReason::slack : PoseReason::not_converged;
}

}  // namespace chaintrue::model
