// SPDX-License-Identifier: GPL-3.0-or-later
// Every derivative of the lengths from one elimination: how a parameter changes (1) and (2), and
// how the unknowns respond.
#include <numbers>

#include "model/equilibrium_kinematics.hpp"

namespace chaintrue::model {
namespace {

/// The state of the pose.
EquilibriumState state_of(const Pose& pose) {
  return {pose.chains.left.horizontal_n,
          pose.chains.left.vertical_at_sled_n,
          {pose.chains.left.free_length_mm, pose.chains.right.free_length_mm},
          pose.sled_rotation_rad};
}

/// d(length) of one chain for a step of its own unknowns.
double length_change(
    const EquilibriumConstants& m, const ChainTerms& t, double h, double v, double s) {
  return s + m.sg * m.r * (t.phi_h * h + t.phi_v * v + t.phi_s * s);
}

template <bool kRotates>
Eigen::Vector2d length_changes(const EquilibriumConstants& m,
                               const PerSide<ChainTerms>& t,
                               const EquilibriumLoad& load,
                               double psi) {
  const EquilibriumStep d = solve_linearised<kRotates>(m, t, load, psi);
  return {length_change(m, t.left, d.h_left, d.v_left, d.s.left),
          length_change(m, t.right, d.h_right, d.v_right, d.s.right)};
}

}  // namespace

template <bool kRotates>
Eigen::Matrix2d EquilibriumKinematics<kRotates>::jacobian(const Pose& pose) const {
  const EquilibriumState q = state_of(pose);
  const PerSide<ChainTerms> t = terms_of(m_, q);
  EquilibriumLoad by_x, by_y;
  by_x.u = {-1.0, 1.0};
  by_y.y = {1.0, 1.0};
  Eigen::Matrix2d j;
  j.col(0) = length_changes<kRotates>(m_, t, by_x, q.psi);
  j.col(1) = length_changes<kRotates>(m_, t, by_y, q.psi);
  return j;
}

template <bool kRotates>
Eigen::Vector2d EquilibriumKinematics<kRotates>::sensitivity(const Pose& pose,
                                                             Parameter parameter) const {
  Eigen::Vector2d direct = Eigen::Vector2d::Zero();
  if ((parameter == Parameter::sprocket_radius_mm && not_modelled_.sprocket) ||
      (parameter == Parameter::chain_weight_n_per_mm && not_modelled_.chain_weight) ||
      (parameter == Parameter::chain_compliance_per_n && not_modelled_.compliance)) {
    return direct;
  }
  const EquilibriumState q = state_of(pose);
  const PerSide<ChainTerms> t = terms_of(m_, q);
  EquilibriumLoad load;
  const auto each = [&](auto&& put) {
    for (const Side side : kSides) put(side, t[side], side == Side::left ? q.s.left : q.s.right);
  };
  switch (parameter) {
    case Parameter::motor_left_x_mm:
      load.u.left = 1.0;
      break;
    case Parameter::motor_left_y_mm:
      load.y.left = -1.0;
      break;
    case Parameter::motor_right_x_mm:
      load.u.right = -1.0;
      break;
    case Parameter::motor_right_y_mm:
      load.y.right = -1.0;
      break;
    case Parameter::ring_radius_mm:
      if constexpr (kRotates) return direct;
      each([&](Side side, const ChainTerms& c, double) {
        load.u[side] = c.h / c.ta;
        load.y[side] = c.v / c.ta;
      });
      break;
    case Parameter::sprocket_radius_mm:
      each([&](Side side, const ChainTerms& c, double) {
        load.u[side] = m_.sg * c.vb / c.tb;
        load.y[side] = -m_.sg * c.h / c.tb;
        const double phi = std::atan2(c.vb, c.h);
        direct[side == Side::left ? 0 : 1] = m_.sg > 0 ? phi : std::numbers::pi - phi;
      });
      break;
    case Parameter::sled_weight_n:
      load.vertical_n = 1.0;
      break;
    case Parameter::chain_weight_n_per_mm:
      each([&](Side side, const ChainTerms& c, double s) {
        const CatenaryByWeight by_w = catenary_by_weight({c.h, c.v, s}, m_.chain);
        // Vb grows by S: the tangent turns and the pull on the beam grows.
        const double phi_w = c.phi_v * s;
        load.u[side] = by_w.u_mm + m_.sg * m_.r * c.h / c.tb * phi_w;
        load.y[side] = by_w.y_mm + m_.sg * m_.r * c.vb / c.tb * phi_w + m_.k * s;
        direct[side == Side::left ? 0 : 1] = m_.sg * m_.r * phi_w;
      });
      break;
    case Parameter::chain_compliance_per_n:
      each([&](Side side, const ChainTerms& c, double s) {
        load.u[side] = c.h * s;
        load.y[side] = 0.5 * (c.v + c.vb) * s;
      });
      break;
    case Parameter::beam_flexibility_mm_per_n:
      each([&](Side side, const ChainTerms& c, double) {
        load.u[side] = c.h;
        load.y[side] = c.vb;
      });
      break;
    case Parameter::side_force_n:
      load.side_n = 1.0;
      break;
  }
  return direct + length_changes<kRotates>(m_, t, load, q.psi);
}

template Eigen::Matrix2d EquilibriumKinematics<false>::jacobian(const Pose&) const;
template Eigen::Matrix2d EquilibriumKinematics<true>::jacobian(const Pose&) const;
template Eigen::Vector2d EquilibriumKinematics<false>::sensitivity(const Pose&, Parameter) const;
template Eigen::Vector2d EquilibriumKinematics<true>::sensitivity(const Pose&, Parameter) const;

}  // namespace chaintrue::model
