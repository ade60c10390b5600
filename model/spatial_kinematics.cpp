// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/spatial_kinematics.hpp"

#include <Eigen/Geometry>

#include "model/equilibrium_newton.hpp"
#include "model/forward_fallback.hpp"

namespace chaintrue::model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Constants of the machine for the evaluation of one chain.
struct Spatial {
  const EquilibriumConstants& m;
  Vector3d up;
  double w0 = 0.0;

  Spatial(const EquilibriumConstants& constants, double cos_tilt, double sin_tilt)
      : m(constants), up(0.0, cos_tilt, sin_tilt), w0(constants.chain.weight_n_per_mm / cos_tilt) {}
};

struct SpatialState {
  EquilibriumState plane;
  PerSide<double> n;
};

/// From the attachment to the motor's axis, and derivatives by (H, V, N) and S; z must vanish.
struct SpatialTerms {
  Vector3d tip = Vector3d::Zero();
  Matrix3d by_pull = Matrix3d::Zero();
  Vector3d by_s = Vector3d::Zero();
  double phi_h = 0.0, phi_v = 0.0, phi_s = 0.0;
  double h = 0.0, v = 0.0, vb = 0.0, ta = 0.0, tb = 0.0;
  Vector3d ring_direction = Vector3d::Zero();
  double in_sheet = 0.0;  // tension at the sprocket, the part in the sheet
};

/// The vertical plane that a chain hangs in.
struct HangingPlane {
  CatenaryLoad load;
  Vector3d across;  // unit, along h
};

HangingPlane hanging_plane(const Spatial& q, const Vector3d& pull, double s) {
  const double v = pull.dot(q.up);
  const Vector3d h = pull - v * q.up;
  const double size = h.norm();
  return {{size, v, s}, h / size};
}

SpatialTerms spatial_terms(const Spatial& q, const Vector3d& pull, double s) {
  const HangingPlane plane = hanging_plane(q, pull, s);
  const CatenaryExtent e = catenary_extent(plane.load, {q.w0, q.m.chain.compliance_per_n});
  const Vector3d& c = plane.across;
  const Vector3d out = c.cross(q.up);
  SpatialTerms t;
  t.h = pull.x();
  t.v = pull.y();
  t.vb = pull.y() + q.m.chain.weight_n_per_mm * s;
  t.ta = e.ta_n;
  t.tb = e.tb_n;
  t.in_sheet = std::sqrt(t.h * t.h + t.vb * t.vb);
  t.ring_direction = pull / e.ta_n;
  const double cos_b = t.h / t.in_sheet, sin_b = t.vb / t.in_sheet;
  t.phi_h = -sin_b / t.in_sheet;
  t.phi_v = cos_b / t.in_sheet;
  t.phi_s = q.m.chain.weight_n_per_mm * t.phi_v;
  const Vector3d tangent = q.m.sg * q.m.r * Vector3d(cos_b, sin_b, 0.0);  // d(tangent point)/d(phi)
  const Vector3d end_pull = pull + q.w0 * s * q.up;
  t.tip = q.m.rho * t.ring_direction + e.u_mm * c + e.y_mm * q.up +
          q.m.sg * q.m.r * Vector3d(sin_b, -cos_b, 0.0) + q.m.k * Vector3d(t.h, t.vb, 0.0);
  t.by_pull =
      e.u_by_h * c * c.transpose() + e.u_by_v * (c * q.up.transpose() + q.up * c.transpose()) +
      e.y_by_v * q.up * q.up.transpose() +
      e.u_mm / plane.load.horizontal_n * out * out.transpose() +
      q.m.rho / t.ta * (Matrix3d::Identity() - t.ring_direction * t.ring_direction.transpose()) +
      tangent * Vector3d(t.phi_h, t.phi_v, 0.0).transpose();
  t.by_pull(0, 0) += q.m.k;
  t.by_pull(1, 1) += q.m.k;
  t.by_s = end_pull * (1.0 / t.tb + q.m.chain.compliance_per_n) + tangent * t.phi_s;
  t.by_s.y() += q.m.k * q.m.chain.weight_n_per_mm;
  return t;
}

PerSide<SpatialTerms> terms_of(const Spatial& q, const SpatialState& x) {
  const EquilibriumState& p = x.plane;
  return {spatial_terms(q, {p.h_left, p.v_left, x.n.left}, p.s.left),
          spatial_terms(q, {p.h_left - q.m.f, q.m.W - p.v_left, x.n.right}, p.s.right)};
}

/// The moment about the bit depends on the pulls in the sheet alone.
PerSide<ChainTerms> in_sheet(const PerSide<SpatialTerms>& t) {
  PerSide<ChainTerms> plane;
  for (const Side side : kSides) {
    plane[side].h = t[side].h;
    plane[side].v = t[side].v;
  }
  return plane;
}

struct SpatialLoad {
  PerSide<Vector3d> tip{Vector3d::Zero(), Vector3d::Zero()};
  EquilibriumLoad sled;  // moment, vertical_n and side_n
};

struct SpatialStep {
  EquilibriumStep plane;
  PerSide<double> n;
};

/// Solves terms * step + load = 0: N and S of each chain are eliminated by projection on the normal
/// of their two columns.
template <bool kRotates>
SpatialStep solve_linearised(const EquilibriumConstants& m,
                             const PerSide<SpatialTerms>& t,
                             const SpatialLoad& load,
                             double psi) {
  Attachments a;
  double moment_psi = 0.0;
  if constexpr (kRotates) {
    a = attachments(m, psi);
    moment_psi = moment_by_psi(m, a, in_sheet(t), psi);
  }
  const PerSide<Vector3d> by_psi{{a.left_y, a.left_x, 0.0}, {-a.right_y, a.right_x, 0.0}};
  PerSide<Vector3d> normal;
  PerSide<SledRow> row;
  for (const Side side : kSides) {
    const SpatialTerms& c = t[side];
    normal[side] = c.by_pull.col(2).cross(c.by_s);
    row[side] = {normal[side].dot(c.by_pull.col(0)),
                 normal[side].dot(c.by_pull.col(1)),
                 normal[side].dot(by_psi[side]),
                 normal[side].dot(load.tip[side])};
  }
  SpatialStep step;
  step.plane = solve_sled<kRotates>(m, row.left, row.right, load.sled, a, psi, moment_psi);
  for (const Side side : kSides) {
    const SpatialTerms& c = t[side];
    const bool left = side == Side::left;
    const Vector3d rest = load.tip[side] +
                          c.by_pull.col(0) * (left ? step.plane.h_left : step.plane.h_right) +
                          c.by_pull.col(1) * (left ? step.plane.v_left : step.plane.v_right) +
                          by_psi[side] * step.plane.psi;
    // rest + col_N dN + by_s dS = 0 in the plane of the two columns.
    const double per_square = 1.0 / normal[side].squaredNorm();
    step.n[side] = -rest.cross(c.by_s).dot(normal[side]) * per_square;
    step.plane.s[side] = -c.by_pull.col(2).cross(rest).dot(normal[side]) * per_square;
  }
  return step;
}

SpatialState spatial_start(const Spatial& q, BedPoint p) {
  SpatialState x;
  x.plane = straight_start(q.m, p);
  // Each end carries half of the chain's weight off the sheet.
  for (const Side side : kSides) x.n[side] = -0.5 * q.w0 * q.up.z() * x.plane.s[side];
  return x;
}

template <bool kRotates>
int converge_inverse(const Spatial& q, BedPoint p, SpatialState& x) {
  const EquilibriumConstants& m = q.m;
  for (int n = 1; n <= kMaxIterations; ++n) {
    const PerSide<SpatialTerms> t = terms_of(q, x);
    Attachments a;
    if constexpr (kRotates) a = attachments(m, x.plane.psi);
    SpatialLoad residual;
    residual.tip.left = t.left.tip - Vector3d(p.x_mm + a.left_x - m.motors.left.x_mm,
                                              m.motors.left.y_mm - p.y_mm - a.left_y,
                                              0.0);
    residual.tip.right = t.right.tip - Vector3d(m.motors.right.x_mm - p.x_mm - a.right_x,
                                                m.motors.right.y_mm - p.y_mm - a.right_y,
                                                0.0);
    if constexpr (kRotates) {
      residual.sled.moment = moment_about_bit(m, a, in_sheet(t), x.plane.psi);
    }
    const SpatialStep step = solve_linearised<kRotates>(m, t, residual, x.plane.psi);
    const EquilibriumStep& d = step.plane;
    if (!std::isfinite(d.h_left + d.v_left + d.s.left + d.s.right + d.psi + step.n.left +
                       step.n.right)) {
      return 0;
    }
    const bool converged = advance<kRotates>(m, d, x.plane);
    x.n.left += step.n.left;
    x.n.right += step.n.right;
    if (converged &&
        std::abs(step.n.left) + std::abs(step.n.right) < kRelativeForceStep * (m.W + 1.0)) {
      return n;
    }
  }
  return 0;
}

ChainState chain_state(const Spatial& q, const SpatialTerms& t, double n, double s) {
  ChainState state;
  state.horizontal_n = t.h;
  state.vertical_at_sled_n = t.v;
  state.out_of_sheet_n = n;
  state.tension_at_sled_n = t.ta;
  state.tension_at_sprocket_n = t.tb;
  state.angle_rad = std::atan2(t.vb, t.h);
  state.free_length_mm = s;
  state.wrap_mm = q.m.wrap(state.angle_rad);
  return state;
}

SpatialState state_of(const Pose& pose) {
  const ChainState &l = pose.chains.left, &r = pose.chains.right;
  return {{l.horizontal_n,
           l.vertical_at_sled_n,
           {l.free_length_mm, r.free_length_mm},
           pose.sled_rotation_rad},
          {l.out_of_sheet_n, r.out_of_sheet_n}};
}

template <bool kRotates>
Eigen::Vector2d length_changes(const EquilibriumConstants& m,
                               const PerSide<SpatialTerms>& t,
                               const SpatialLoad& load,
                               double psi) {
  const EquilibriumStep d = solve_linearised<kRotates>(m, t, load, psi).plane;
  const auto change = [&m](const SpatialTerms& c, double h, double v, double s) {
    return s + m.sg * m.r * (c.phi_h * h + c.phi_v * v + c.phi_s * s);
  };
  return {change(t.left, d.h_left, d.v_left, d.s.left),
          change(t.right, d.h_right, d.v_right, d.s.right)};
}

}  // namespace

template <bool kRotates>
SpatialKinematics<kRotates>::SpatialKinematics(const EquilibriumParameters& parameters)
    : m_(equilibrium_constants(parameters)),
      cos_tilt_(std::cos(parameters.tilt_rad)),
      sin_tilt_(std::sin(parameters.tilt_rad)) {}

template <bool kRotates>
PoseResult SpatialKinematics<kRotates>::inverse(BedPoint point) const {
  if (const auto failure = domain_failure(limits_of(m_), point)) return tl::unexpected(*failure);
  const Spatial q(m_, cos_tilt_, sin_tilt_);
  SpatialState x = spatial_start(q, point);
  int iterations = converge_inverse<kRotates>(q, point, x);
  if (iterations == 0) {
    iterations = converge_by_continuation(
        m_,
        point,
        x,
        [&q](BedPoint p) { return spatial_start(q, p); },
        [&q](BedPoint p, SpatialState& state) { return converge_inverse<kRotates>(q, p, state); });
  }
  if (iterations == 0) return tl::unexpected(why_not_converged(m_, point));
  const PerSide<SpatialTerms> t = terms_of(q, x);
  Pose pose;
  pose.position = point;
  pose.sled_rotation_rad = x.plane.psi;
  pose.chains = {chain_state(q, t.left, x.n.left, x.plane.s.left),
                 chain_state(q, t.right, x.n.right, x.plane.s.right)};
  pose.lengths = {pose.chains.left.wrap_mm + x.plane.s.left,
                  pose.chains.right.wrap_mm + x.plane.s.right};
  pose.iterations = iterations;
  return pose;
}

template <bool kRotates>
PoseResult SpatialKinematics<kRotates>::forward(ChainLengths lengths) const {
  return forward_by_inverse(*this, limits_of(m_), lengths);
}

template <bool kRotates>
Eigen::Matrix2d SpatialKinematics<kRotates>::jacobian(const Pose& pose) const {
  const SpatialState x = state_of(pose);
  const PerSide<SpatialTerms> t = terms_of(Spatial(m_, cos_tilt_, sin_tilt_), x);
  SpatialLoad by_x, by_y;
  by_x.tip = {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  by_y.tip = {{0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  Eigen::Matrix2d j;
  j.col(0) = length_changes<kRotates>(m_, t, by_x, x.plane.psi);
  j.col(1) = length_changes<kRotates>(m_, t, by_y, x.plane.psi);
  return j;
}

template <bool kRotates>
Eigen::Vector2d SpatialKinematics<kRotates>::sensitivity(const Pose& pose,
                                                         Parameter parameter) const {
  const SpatialState x = state_of(pose);
  const Spatial q(m_, cos_tilt_, sin_tilt_);
  const PerSide<SpatialTerms> t = terms_of(q, x);
  SpatialLoad load;
  Eigen::Vector2d direct = Eigen::Vector2d::Zero();
  const auto each = [&](auto&& tip) {
    for (const Side side : kSides) load.tip[side] = tip(side, t[side]);
  };
  switch (parameter) {
    case Parameter::motor_left_x_mm:
      load.tip.left.x() = 1.0;
      break;
    case Parameter::motor_left_y_mm:
      load.tip.left.y() = -1.0;
      break;
    case Parameter::motor_right_x_mm:
      load.tip.right.x() = -1.0;
      break;
    case Parameter::motor_right_y_mm:
      load.tip.right.y() = -1.0;
      break;
    case Parameter::ring_radius_mm:
      if constexpr (kRotates) return direct;
      each([](Side, const SpatialTerms& c) -> Vector3d { return c.ring_direction; });
      break;
    case Parameter::sprocket_radius_mm:
      each([&](Side side, const SpatialTerms& c) -> Vector3d {
        const double phi = std::atan2(c.vb, c.h);
        direct[side == Side::left ? 0 : 1] = m_.sg > 0 ? phi : std::numbers::pi - phi;
        return m_.sg / c.in_sheet * Vector3d(c.vb, -c.h, 0.0);
      });
      break;
    case Parameter::sled_weight_n:
      load.sled.vertical_n = 1.0;
      break;
    case Parameter::chain_weight_n_per_mm:
      each([&](Side side, const SpatialTerms& c) -> Vector3d {
        const double s = x.plane.s[side];
        const HangingPlane plane = hanging_plane(q, {c.h, c.v, x.n[side]}, s);
        const CatenaryByWeight by_w0 =
            catenary_by_weight(plane.load, {q.w0, m_.chain.compliance_per_n});
        const double phi_w = c.phi_v * s;
        direct[side == Side::left ? 0 : 1] = m_.sg * m_.r * phi_w;
        return (by_w0.u_mm * plane.across + by_w0.y_mm * q.up) / cos_tilt_ +
               m_.sg * m_.r * phi_w / c.in_sheet * Vector3d(c.h, c.vb, 0.0) +
               Vector3d(0.0, m_.k * s, 0.0);
      });
      break;
    case Parameter::chain_compliance_per_n:
      each([&](Side side, const SpatialTerms& c) -> Vector3d {
        const double s = x.plane.s[side];
        return s * (Vector3d(c.h, c.v, x.n[side]) + 0.5 * q.w0 * s * q.up);
      });
      break;
    case Parameter::beam_flexibility_mm_per_n:
      each([](Side, const SpatialTerms& c) -> Vector3d { return {c.h, c.vb, 0.0}; });
      break;
    case Parameter::side_force_n:
      load.sled.side_n = 1.0;
      break;
  }
  return direct + length_changes<kRotates>(m_, t, load, x.plane.psi);
}

template class SpatialKinematics<false>;
template class SpatialKinematics<true>;

}  // namespace chaintrue::model
