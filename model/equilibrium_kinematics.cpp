// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/equilibrium_kinematics.hpp"

#include <algorithm>
#include <stdexcept>

#include "model/chain_formulas.hpp"
#include "model/forward_fallback.hpp"

namespace chaintrue::model {
namespace {

constexpr int kMaxIterations = 50;
// Newton is quadratic: a step below these leaves less than rounding behind it.
constexpr double kLengthStepMm = 1e-7;
constexpr double kRelativeForceStep = 1e-7;
constexpr double kAngleStepRad = 1e-9;

/// A bracket reaches as far from the bit as its corner.
DomainLimits limits_of(const EquilibriumConstants& m) {
  return {m.motors,
          m.r,
          m.sg,
          m.rho + std::sqrt(m.half_spacing * m.half_spacing + m.bracket_height * m.bracket_height)};
}

PerSide<ChainTerms> terms_of(const EquilibriumConstants& m, const EquilibriumState& q) {
  return {chain_terms(m, q.h_left, q.v_left, q.s.left),
          chain_terms(m, q.h_left - m.f, m.W - q.v_left, q.s.right)};
}

/// Straight tangents carry sled and chains: the start of every solution.
EquilibriumState straight_start(const EquilibriumConstants& m, BedPoint p) {
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
  // Beside a bracket's vertical or at the beam the straight line has no equilibrium; Newton starts
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
  keep(h_right, step.h_right);
  keep(q.s.left, step.s.left);
  keep(q.s.right, step.s.right);
  if constexpr (kRotates) {
    constexpr double kMaxTurn = 0.3;  // rad: the bracket's moment is no longer nearly linear beyond
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

ChainState chain_state(const EquilibriumConstants& m, double h, double v, double s) {
  const double vb = v + m.chain.weight_n_per_mm * s;
  ChainState state;
  state.horizontal_n = h;
  state.vertical_at_sled_n = v;
  state.tension_at_sled_n = std::sqrt(h * h + v * v);
  state.tension_at_sprocket_n = std::sqrt(h * h + vb * vb);
  state.angle_rad = std::atan2(vb, h);
  state.free_length_mm = s;
  state.wrap_mm = m.wrap(state.angle_rad);
  return state;
}

Pose pose_of(const EquilibriumConstants& m, const EquilibriumState& q, BedPoint p, int iterations) {
  Pose pose;
  pose.position = p;
  pose.sled_rotation_rad = q.psi;
  pose.chains.left = chain_state(m, q.h_left, q.v_left, q.s.left);
  pose.chains.right = chain_state(m, q.h_left - m.f, m.W - q.v_left, q.s.right);
  pose.lengths = {pose.chains.left.wrap_mm + q.s.left, pose.chains.right.wrap_mm + q.s.right};
  pose.iterations = iterations;
  return pose;
}

/// Newton on (1) and (2) from `q`. \returns iterations, or 0 where it did not settle.
template <bool kRotates>
int settle_inverse(const EquilibriumConstants& m, BedPoint p, EquilibriumState& q) {
  for (int n = 1; n <= kMaxIterations; ++n) {
    const PerSide<ChainTerms> t = terms_of(m, q);
    Attachments a;
    if constexpr (kRotates) a = attachments(m, q.psi);
    EquilibriumLoad residual;
    residual.u = {t.left.tip_u - (p.x_mm + a.left_x - m.motors.left.x_mm),
                  t.right.tip_u - (m.motors.right.x_mm - p.x_mm - a.right_x)};
    residual.y = {t.left.tip_y - (m.motors.left.y_mm - p.y_mm - a.left_y),
                  t.right.tip_y - (m.motors.right.y_mm - p.y_mm - a.right_y)};
    if constexpr (kRotates) residual.moment = moment_about_bit(m, a, t, q.psi);
    const EquilibriumStep step = solve_linearised<kRotates>(m, t, residual, q.psi);
    if (!std::isfinite(step.h_left + step.v_left + step.s.left + step.s.right + step.psi)) return 0;
    if (advance<kRotates>(m, step, q)) return n;
  }
  return 0;
}

/// Walks from below the beam's middle to the point in steps that Newton can follow: the branch of
/// solutions that belongs to taut chains, where a cold start finds none.
template <bool kRotates>
int settle_by_walking(const EquilibriumConstants& m, BedPoint p, EquilibriumState& q) {
  const MotorPosition &l = m.motors.left, &r = m.motors.right;
  const BedPoint middle{0.5 * (l.x_mm + r.x_mm),
                        std::min(p.y_mm, 0.5 * (l.y_mm + r.y_mm) - 0.2 * (r.x_mm - l.x_mm))};
  q = straight_start(m, middle);
  int total = settle_inverse<kRotates>(m, middle, q);
  if (total == 0) return 0;
  double reached = 0.0, stride = 0.25;
  while (reached < 1.0) {
    const double next = std::min(1.0, reached + stride);
    EquilibriumState trial = q;
    const int n = settle_inverse<kRotates>(
        m,
        {middle.x_mm + next * (p.x_mm - middle.x_mm), middle.y_mm + next * (p.y_mm - middle.y_mm)},
        trial);
    total += n;
    if (n != 0) {
      q = trial;
      reached = next;
      stride *= 1.5;
    } else if ((stride *= 0.5) < 1e-4) {
      return 0;
    }
  }
  return total;
}

/// The likeliest reason for a point inside the domain where nothing settles.
PoseFailure why_unsettled(const EquilibriumConstants& m, BedPoint p) {
  const double u = std::min(p.x_mm - m.motors.left.x_mm, m.motors.right.x_mm - p.x_mm);
  if (u - m.half_spacing <= m.sg * m.r) return PoseFailure::outside_verticals;
  return m.f != 0.0 ? PoseFailure::slack : PoseFailure::not_converged;
}

}  // namespace

EquilibriumConstants equilibrium_constants(const EquilibriumParameters& parameters) {
  EquilibriumConstants m;
  m.motors = parameters.motors;
  m.r = parameters.sprocket_radius_mm;
  m.sg = parameters.feed == Feed::over_top ? 1.0 : -1.0;
  if (const auto* ring = std::get_if<Ring>(&parameters.attachment)) m.rho = ring->radius_mm;
  if (const auto* brackets = std::get_if<Brackets>(&parameters.attachment)) {
    m.half_spacing = 0.5 * brackets->spacing_mm;
    m.bracket_height = brackets->height_mm;
    m.cg = brackets->cg_below_bit_mm;
  }
  m.W = parameters.sled_weight_n;
  m.k = parameters.beam_flexibility_mm_per_n;
  m.f = parameters.side_force_n;
  m.chain = {parameters.chain_weight_n_per_mm, parameters.chain_compliance_per_n};
  return m;
}

template <bool kRotates>
PoseResult EquilibriumKinematics<kRotates>::inverse(BedPoint point) const {
  if (const auto failure = domain_failure(limits_of(m_), point)) return tl::unexpected(*failure);
  EquilibriumState q = straight_start(m_, point);
  int iterations = settle_inverse<kRotates>(m_, point, q);
  if (iterations == 0) iterations = settle_by_walking<kRotates>(m_, point, q);
  if (iterations == 0) return tl::unexpected(why_unsettled(m_, point));
  return pose_of(m_, q, point, iterations);
}

template <bool kRotates>
PoseResult EquilibriumKinematics<kRotates>::forward(ChainLengths lengths) const {
  const DomainLimits limits = limits_of(m_);
  if (!(lengths.left_mm > 0.0 && lengths.right_mm > 0.0 && std::isfinite(lengths.left_mm) &&
        std::isfinite(lengths.right_mm))) {
    return tl::unexpected(PoseFailure::too_short);
  }
  const CircleGuess guess = circle_guess(limits, lengths);
  if (!guess.circles_meet) return forward_by_inverse(*this, limits, lengths);
  EquilibriumState q = straight_start(m_, guess.point);
  const double span = m_.motors.right.x_mm - m_.motors.left.x_mm;
  const double rise = m_.motors.left.y_mm - m_.motors.right.y_mm;
  for (int n = 1; n <= kMaxIterations; ++n) {
    const PerSide<ChainTerms> t = terms_of(m_, q);
    Attachments a;
    if constexpr (kRotates) a = attachments(m_, q.psi);
    // Each chain's S follows from its length: S + wrap(phi) = L, linearised.
    struct Row {
      double u_h, u_v, y_h, y_v, u, y, s_h, s_v, s;
    };
    const auto row = [this](const ChainTerms& c, double s, double length) {
      const double per = 1.0 / (1.0 + m_.sg * m_.r * c.phi_s);
      Row r{};
      r.s = -(s + m_.wrap(std::atan2(c.vb, c.h)) - length) * per;
      r.s_h = -m_.sg * m_.r * c.phi_h * per;
      r.s_v = -m_.sg * m_.r * c.phi_v * per;
      r.u_h = c.u_h + c.u_s * r.s_h;
      r.u_v = c.u_v + c.u_s * r.s_v;
      r.y_h = c.y_h + c.y_s * r.s_h;
      r.y_v = c.y_v + c.y_s * r.s_v;
      r.u = c.tip_u + c.u_s * r.s;
      r.y = c.tip_y + c.y_s * r.s;
      return r;
    };
    const Row l = row(t.left, q.s.left, lengths.left_mm);
    const Row r = row(t.right, q.s.right, lengths.right_mm);
    // Both chains end at one sled: across and in height.
    const double cx = l.u + r.u - a.left_x + a.right_x - span;
    const double cy = l.y - r.y + a.left_y - a.right_y - rise;
    const double a00 = l.u_h + r.u_h, a01 = l.u_v - r.u_v, a10 = l.y_h - r.y_h, a11 = l.y_v + r.y_v;
    EquilibriumStep step;
    if constexpr (kRotates) {
      const double p0 = a.left_y - a.right_y, p1 = a.left_x - a.right_x;
      const double mh = a.left_y - a.right_y, mv = a.left_x - a.right_x;
      const double mp = moment_by_psi(m_, a, t, q.psi), mm = moment_about_bit(m_, a, t, q.psi);
      const double c0 = a11 * mp - p1 * mv, c1 = p1 * mh - a10 * mp, c2 = a10 * mv - a11 * mh;
      const double per_det = 1.0 / (a00 * c0 + a01 * c1 + p0 * c2);
      const double d0 = -cy * mp + p1 * mm, d1 = -cy * mv + a11 * mm, d2 = -a10 * mm + cy * mh;
      step.h_left = per_det * (-cx * c0 - a01 * d0 + p0 * d1);
      step.v_left = per_det * (a00 * d0 - cx * c1 + p0 * d2);
      step.psi = per_det * (-cx * c2 - a01 * d2 - a00 * d1);
    } else {
      const double per_det = 1.0 / (a00 * a11 - a01 * a10);
      step.h_left = per_det * (a01 * cy - a11 * cx);
      step.v_left = per_det * (a10 * cx - a00 * cy);
    }
    step.h_right = step.h_left;
    step.v_right = -step.v_left;
    step.s.left = l.s + l.s_h * step.h_left + l.s_v * step.v_left;
    step.s.right = r.s + r.s_h * step.h_right + r.s_v * step.v_right;
    if (!std::isfinite(step.h_left + step.v_left + step.s.left + step.s.right + step.psi)) break;
    if (!advance<kRotates>(m_, step, q)) continue;
    const PerSide<ChainTerms> end = terms_of(m_, q);
    if constexpr (kRotates) a = attachments(m_, q.psi);
    // Left and right say the same to rounding; their mean keeps the mirror exact.
    const BedPoint p{0.5 * (m_.motors.left.x_mm + end.left.tip_u - a.left_x +
                            (m_.motors.right.x_mm - end.right.tip_u - a.right_x)),
                     0.5 * (m_.motors.left.y_mm - end.left.tip_y - a.left_y +
                            (m_.motors.right.y_mm - end.right.tip_y - a.right_y))};
    if (domain_failure(limits, p)) break;
    return pose_of(m_, q, p, n);
  }
  return forward_by_inverse(*this, limits, lengths);
}

namespace {

/// The state that a pose speaks of.
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
  const EquilibriumState q = state_of(pose);
  const PerSide<ChainTerms> t = terms_of(m_, q);
  EquilibriumLoad load;
  Eigen::Vector2d direct = Eigen::Vector2d::Zero();
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
        // Vb grows by S: the tangent turns and the beam is pulled harder.
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

template class EquilibriumKinematics<false>;
template class EquilibriumKinematics<true>;

}  // namespace chaintrue::model
