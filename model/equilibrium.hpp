// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The equilibrium of sled and chains as equations and their derivatives, shared by the pose, its
/// Jacobian and its sensitivities. Internal to model/; kinematics.hpp is the interface.
///
/// Notation, in addition to catenary.hpp's
///   u, y     per chain: horizontal from the sled towards its sprocket, and up
///   sg, r    +1 over the top, -1 off the bottom; sprocket radius
///   phi      slope of the chain where it leaves the sprocket, atan2(Vb, H)
///   wrap     r phi or r (pi - phi)
///   rho      ring radius
///   k        beam flexibility
///   W        sled weight
///   f        side force, H_left - H_right
///   psi, a   sled's rotation (brackets), and the attachment points relative to the bit
///
/// Per chain, from the attachment to the motor's axis (U, Y):
///   F_u = rho H/Ta + u + sg r Vb/Tb + k H  - U = 0
///   F_y = rho V/Ta + y - sg r H/Tb  + k Vb - Y = 0                                          (1)
/// and on the sled V_left + V_right = W, H_left - H_right = f, and for brackets, about the bit,
///   M = aLx V_L + aLy H_L + aRx V_R - aRy H_R - W cg sin(psi) = 0                           (2)
/// With a ring both pulls pass through the bit, so that the sled is a point. Unknowns: H_left,
/// V_left, S of both chains and psi; each chain's S is eliminated by projecting (1) on the normal
/// of its S column, which leaves a 2 x 2 or 3 x 3 system. The same elimination gives every
/// derivative.
#pragma once

#include <cmath>
#include <numbers>

#include "model/hanging_body.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {

/// Constants of the equations from the parameters, laid out for the hot path.
struct EquilibriumConstants {
  PerSide<MotorPosition> motors;
  double r = 0.0, sg = 1.0, rho = 0.0;
  double half_spacing = 0.0, bracket_height = 0.0, cg = 0.0;
  double W = 0.0, k = 0.0, f = 0.0;
  bool rotates = false;  ///< brackets
  /// The frame's tilt, for the equilibrium in space.
  double cos_tilt = 1.0, sin_tilt = 0.0;
  ChainMaterial chain;

  double wrap(double phi) const { return sg > 0 ? r * phi : r * (std::numbers::pi - phi); }
};

EquilibriumConstants equilibrium_constants(const EquilibriumParameters& parameters);

/// Left side of (1) without U and Y, and its derivatives by the chain's own H, V and S.
struct ChainTerms {
  double tip_u = 0.0, tip_y = 0.0;
  double u_h = 0.0, u_v = 0.0, y_h = 0.0, y_v = 0.0, u_s = 0.0, y_s = 0.0;
  double phi_h = 0.0, phi_v = 0.0, phi_s = 0.0;
  double h = 0.0, v = 0.0, vb = 0.0, ta = 0.0, tb = 0.0;
};

inline ChainTerms chain_terms(const EquilibriumConstants& m, double h, double v, double s) {
  const CatenaryExtent e = catenary_extent({h, v, s}, m.chain);
  const double w = m.chain.weight_n_per_mm;
  const double per_a = 1.0 / e.ta_n, per_b = 1.0 / e.tb_n;
  const double cos_a = h * per_a, sin_a = v * per_a, cos_b = h * per_b, sin_b = e.vb_n * per_b;
  ChainTerms t;
  t.h = h;
  t.v = v;
  t.vb = e.vb_n;
  t.ta = e.ta_n;
  t.tb = e.tb_n;
  t.tip_u = m.rho * cos_a + e.u_mm + m.sg * m.r * sin_b + m.k * h;
  t.tip_y = m.rho * sin_a + e.y_mm - m.sg * m.r * cos_b + m.k * e.vb_n;
  t.phi_h = -sin_b * per_b;
  t.phi_v = cos_b * per_b;
  t.phi_s = w * t.phi_v;
  const double ring = m.rho * per_a, tangent_u = m.sg * m.r * cos_b, tangent_y = m.sg * m.r * sin_b;
  t.u_h = e.u_by_h + ring * sin_a * sin_a + tangent_u * t.phi_h + m.k;
  t.u_v = e.u_by_v - ring * sin_a * cos_a + tangent_u * t.phi_v;
  t.y_h = e.u_by_v - ring * sin_a * cos_a + tangent_y * t.phi_h;
  t.y_v = e.y_by_v + ring * cos_a * cos_a + tangent_y * t.phi_v + m.k;
  const double along = 1.0 + m.chain.compliance_per_n * e.tb_n;
  t.u_s = cos_b * along + tangent_u * t.phi_s;
  t.y_s = sin_b * along + tangent_y * t.phi_s + m.k * w;
  return t;
}

/// The attachment points relative to the bit; zero for a ring, whose radius is in rho.
struct Attachments {
  double left_x = 0.0, left_y = 0.0, right_x = 0.0, right_y = 0.0;
};

inline Attachments attachments(const EquilibriumConstants& m, double psi) {
  const double c = std::cos(psi), s = std::sin(psi);
  return {-m.half_spacing * c - m.bracket_height * s, -m.half_spacing * s + m.bracket_height * c,
          m.half_spacing * c - m.bracket_height * s, m.half_spacing * s + m.bracket_height * c};
}

/// Right-hand sides: the residuals of the equations (Newton), or their derivatives by a parameter.
struct EquilibriumLoad {
  PerSide<double> u, y;
  double moment = 0.0;
};

inline PerSide<ChainTerms> terms_of(const EquilibriumConstants& m, const Unknowns<double>& q) {
  return {chain_terms(m, q[kH], q[kV], q[kSLeft]),
          chain_terms(m, q[kH] - m.f, m.W - q[kV], q[kSRight])};
}

/// Left side of (2).
inline double moment_about_bit(const EquilibriumConstants& m, const Attachments& a,
                               const PerSide<ChainTerms>& t, double psi) {
  return a.left_x * t.left.v + a.left_y * t.left.h + a.right_x * t.right.v - a.right_y * t.right.h -
         m.W * m.cg * std::sin(psi);
}

/// Its derivative by psi, forces fixed.
inline double moment_by_psi(const EquilibriumConstants& m, const Attachments& a,
                            const PerSide<ChainTerms>& t, double psi) {
  return -a.left_y * t.left.v + a.left_x * t.left.h - a.right_y * t.right.v -
         a.right_x * t.right.h - m.W * m.cg * std::cos(psi);
}

/// An equation in the left chain's H and V and in psi, and its load.
struct SledRow {
  double h = 0.0, v = 0.0, psi = 0.0, load = 0.0;
};

/// Steps of H and V of the left chain and of psi from both equations, and for brackets that of the
/// moment: row * step + load = 0 by Cramer's rule. The right chain's H moves by as much, its V by as
/// much the other way.
/// Zero determinants give infinities, which fail every convergence test.
template <bool kRotates>
Unknowns<double> solve_sled(const SledRow& l, const SledRow& r, const SledRow& moment) {
  Unknowns<double> step{};
  if constexpr (kRotates) {
    const double mh = moment.h, mv = moment.v, mp = moment.psi;
    const double c0 = r.v * mp - r.psi * mv, c1 = r.psi * mh - r.h * mp, c2 = r.h * mv - r.v * mh;
    const double per_det = 1.0 / (l.h * c0 + l.v * c1 + l.psi * c2);
    const double d0 = -r.load * mp + r.psi * moment.load;
    const double d1 = -r.load * mv + r.v * moment.load;
    const double d2 = -r.h * moment.load + r.load * mh;
    step[kH] = per_det * (-l.load * c0 - l.v * d0 + l.psi * d1);
    step[kV] = per_det * (l.h * d0 - l.load * c1 + l.psi * d2);
    step[kTurn] = per_det * (-l.load * c2 - l.v * d2 - l.h * d1);
  } else {
    const double per_det = 1.0 / (l.h * r.v - l.v * r.h);
    step[kH] = per_det * (l.v * r.load - l.load * r.v);
    step[kV] = per_det * (r.h * l.load - l.h * r.load);
  }
  return step;
}

/// (2) linearised.
inline SledRow moment_row(const EquilibriumConstants& m, const Attachments& a,
                          const PerSide<ChainTerms>& t, double psi, double load) {
  return {a.left_y - a.right_y, a.left_x - a.right_x, moment_by_psi(m, a, t, psi), load};
}

/// Solves the linearised equations: terms * step + load = 0.
template <bool kRotates>
Unknowns<double> solve_linearised(const EquilibriumConstants& m, const PerSide<ChainTerms>& t,
                                  const EquilibriumLoad& load, double psi) {
  // With a chain's S eliminated; its V moves against the left one's by `way`.
  const auto row = [](const ChainTerms& c, double way, double u_psi, double y_psi, double u,
                      double y) {
    return SledRow{c.y_s * c.u_h - c.u_s * c.y_h, way * (c.y_s * c.u_v - c.u_s * c.y_v),
                   c.y_s * u_psi - c.u_s * y_psi, c.y_s * u - c.u_s * y};
  };
  Attachments a;
  SledRow moment;
  if constexpr (kRotates) {
    a = attachments(m, psi);
    moment = moment_row(m, a, t, psi, load.moment);
  }
  // dU/dpsi = -a_y on the left and +a_y on the right; dY/dpsi = -a_x on both; (1) holds -U and -Y.
  Unknowns<double> step = solve_sled<kRotates>(
      row(t.left, 1.0, a.left_y, a.left_x, load.u.left, load.y.left),
      row(t.right, -1.0, -a.right_y, a.right_x, load.u.right, load.y.right), moment);
  const auto s_step = [](const ChainTerms& c, double u, double y) {
    return -(c.u_s * u + c.y_s * y) / (c.u_s * c.u_s + c.y_s * c.y_s);
  };
  const ChainTerms &cl = t.left, &cr = t.right;
  step[kSLeft] =
      s_step(cl, load.u.left + cl.u_h * step[kH] + cl.u_v * step[kV] + a.left_y * step[kTurn],
             load.y.left + cl.y_h * step[kH] + cl.y_v * step[kV] + a.left_x * step[kTurn]);
  step[kSRight] =
      s_step(cr, load.u.right + cr.u_h * step[kH] - cr.u_v * step[kV] - a.right_y * step[kTurn],
             load.y.right + cr.y_h * step[kH] - cr.y_v * step[kV] + a.right_x * step[kTurn]);
  return step;
}

}  // namespace chaintrue::model
