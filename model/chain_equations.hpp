// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Equations (1) and (2) of equilibrium.hpp, and the lengths that follow from them, as templates for
/// doubles and Duals: in the sheet's plane, and on a frame that leans back also out of it. Internal
/// to model/. Solved in the plane by hand-written derivatives (equilibrium_kinematics.hpp) and in
/// space as they stand (spatial_kinematics.hpp); both take their sensitivities from here.
///
/// Notation in addition to equilibrium.hpp's, per chain in the frame (u, y, z), z off the sheet
///   t     the frame's tilt; 0 in the plane
///   n     straight up, (0, cos t, sin t)
///   w0    the chain's full weight per mm, w / cos t
///   P     its pull on the sled, (H, V, N);  v = P . n, h = P - v n
///   F, z  2 / (T0 + T1) and w0 S / (T0 + T1), T0 and T1 the tensions at both ends
///
/// The chain hangs as a catenary in the plane of h and n, from the attachment to the motor's axis
///   rho P/T0 + S h (F atanh(z)/z + c) + S (v + w0 S / 2) (F + c) n
///     + sg r (Vb, -H, 0) / |(H, Vb)| + k (H, Vb, 0) = (U, Y, 0)                             (1')
#pragma once

#include <cmath>
#include <numbers>

#include "model/equilibrium.hpp"
#include "model/hanging_body.hpp"

namespace chaintrue::model {

/// The inputs of the lengths: the numbers of Parameter and the tool's place.
template <class T>
struct ChainInputs {
  std::array<T, kParameters> numbers;  ///< in the order of Parameter
  T x, y;

  ChainInputs(const EquilibriumConstants& m, BedPoint place)
      : numbers{m.motors.left.x_mm,
                m.motors.left.y_mm,
                m.motors.right.x_mm,
                m.motors.right.y_mm,
                m.rho,
                m.r,
                m.W,
                m.chain.weight_n_per_mm,
                m.chain.compliance_per_n,
                m.k,
                m.f},
        x(place.x_mm),
        y(place.y_mm) {}
  const T& operator[](Parameter parameter) const {
    return numbers[static_cast<std::size_t>(parameter)];
  }
  /// Outward and upward distances from the place to a motor's axis.
  std::array<T, 2> to_motor(Side side) const {
    if (side == Side::left)
      return {x - (*this)[Parameter::motor_left_x_mm], (*this)[Parameter::motor_left_y_mm] - y};
    return {(*this)[Parameter::motor_right_x_mm] - x, (*this)[Parameter::motor_right_y_mm] - y};
  }
};

/// With derivatives with respect to the place.
inline ChainInputs<Dual<2>> inputs_by_place(const EquilibriumConstants& m, BedPoint place) {
  ChainInputs<Dual<2>> inputs(m, place);
  inputs.x.d[0] = inputs.y.d[1] = 1.0;
  return inputs;
}
/// With the derivative by one parameter, if it counts: the ring's radius does not count with
/// brackets.
inline ChainInputs<Dual<1>> inputs_by_parameter(const EquilibriumConstants& m, BedPoint place,
                                                Parameter parameter, bool counts = true) {
  ChainInputs<Dual<1>> inputs(m, place);
  if (counts && !(m.rotates && parameter == Parameter::ring_radius_mm))
    inputs.numbers[static_cast<std::size_t>(parameter)].d[0] = 1.0;
  return inputs;
}

/// P, and S.
template <class T>
struct ChainPull {
  T h, v, n, s;
};

template <class T>
ChainPull<T> pull_of(const ChainInputs<T>& in, const Unknowns<T>& q, Side side) {
  if (side == Side::left) return {q[kH], q[kV], q[kNLeft], q[kSLeft]};
  return {q[kH] - in[Parameter::side_force_n], in[Parameter::sled_weight_n] - q[kV], q[kNRight],
          q[kSRight]};
}

/// The left side of (1').
template <class T>
std::array<T, 3> chain_end(const EquilibriumConstants& m, const ChainInputs<T>& in,
                           const ChainPull<T>& p) {
  using std::sqrt;
  const T& weight = in[Parameter::chain_weight_n_per_mm];
  const T& compliance = in[Parameter::chain_compliance_per_n];
  const T& give = in[Parameter::beam_flexibility_mm_per_n];
  const T hangs = weight / m.cos_tilt * p.s;  // w0 S
  const T up = p.v * m.cos_tilt + p.n * m.sin_tilt;
  const T level_y = p.v - up * m.cos_tilt, level_z = p.n - up * m.sin_tilt;
  const T square = p.h * p.h + level_y * level_y + level_z * level_z;
  const T tension = sqrt(square + up * up);
  const T sum = tension + sqrt(square + (up + hangs) * (up + hangs));
  const T mean = 2.0 / sum;
  const T along = p.s * (mean * ratio_of(hangs / sum) + compliance);
  const T rise = p.s * (up + 0.5 * hangs) * (mean + compliance);
  const T ring = in[Parameter::ring_radius_mm] / tension;
  const T vb = p.v + weight * p.s;
  const T tangent = m.sg * in[Parameter::sprocket_radius_mm] / sqrt(p.h * p.h + vb * vb);
  return {(ring + along + give) * p.h + tangent * vb,
          ring * p.v + along * level_y + rise * m.cos_tilt - tangent * p.h + give * vb,
          ring * p.n + along * level_z + rise * m.sin_tilt};
}

/// The left sides of (1') of both chains, and of (2); of a ring that is the turn.
template <class T>
Unknowns<T> residual(const EquilibriumConstants& m, const ChainInputs<T>& in,
                     const Unknowns<T>& q) {
  using std::cos;
  using std::sin;
  const T c = cos(q[kTurn]), s = sin(q[kTurn]);
  Unknowns<T> result;
  T moment = -m.cg * in[Parameter::sled_weight_n] * s;
  for (const Side side : kSides) {
    const double outward = side == Side::left ? -1.0 : 1.0;
    const ChainPull<T> pull = pull_of(in, q, side);
    const std::array<T, 3> end = chain_end(m, in, pull);
    const std::array<T, 2> motor = in.to_motor(side);
    const T x = outward * m.half_spacing * c - m.bracket_height * s;
    const T y = outward * m.half_spacing * s + m.bracket_height * c;
    const std::size_t row = side == Side::left ? 0 : 3;
    result[row] = end[0] - motor[0] + outward * x;
    result[row + 1] = end[1] - motor[1] + y;
    result[row + 2] = end[2];
    moment = moment + x * pull.v - outward * y * pull.h;
  }
  result[6] = m.rotates ? moment : q[kTurn];
  return result;
}

/// The chains with these unknowns.
template <int N>
PerSide<ChainNumbers<N>> chains_at(const EquilibriumConstants& m, const ChainInputs<Dual<N>>& in,
                                   const Unknowns<Dual<N>>& q) {
  PerSide<ChainNumbers<N>> chains;
  const Dual<N>& r = in[Parameter::sprocket_radius_mm];
  for (const Side side : kSides) {
    const ChainPull<Dual<N>> p = pull_of(in, q, side);
    const Dual<N> weight = in[Parameter::chain_weight_n_per_mm] * p.s;
    const Dual<N> vb = p.v + weight;
    const Dual<N> nb = p.n + m.sin_tilt / m.cos_tilt * weight;
    const Dual<N> phi = atan2(vb, p.h);
    const Dual<N> wrap = m.sg > 0.0 ? r * phi : r * (std::numbers::pi - phi);
    chains[side] = {p.s + wrap, phi, p.s, sqrt(p.h * p.h + vb * vb + nb * nb), p.h};
  }
  return chains;
}

/// The unknowns of a pose.
inline Unknowns<double> unknowns_of(const Pose& pose) {
  const ChainState &l = pose.chains.left, &r = pose.chains.right;
  return {l.horizontal_n,   l.vertical_at_sled_n, l.free_length_mm,      r.free_length_mm,
          l.out_of_sheet_n, r.out_of_sheet_n,     pose.sled_rotation_rad};
}

Pose pose_of(const EquilibriumConstants& m, const Unknowns<double>& q, BedPoint place,
             int iterations);

}  // namespace chaintrue::model
