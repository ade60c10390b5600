// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/equilibrium_kinematics.hpp"

#include "model/chain_equations.hpp"
#include "model/equilibrium_newton.hpp"
#include "model/forward_fallback.hpp"

namespace chaintrue::model {
namespace {

ChainState chain_state(const EquilibriumConstants& m, double h, double v, double n, double s) {
  const double vb = v + m.chain.weight_n_per_mm * s;
  const double nb = n + m.chain.weight_n_per_mm * m.sin_tilt / m.cos_tilt * s;
  ChainState state;
  state.horizontal_n = h;
  state.vertical_at_sled_n = v;
  state.out_of_sheet_n = n;
  state.tension_at_sled_n = std::sqrt(h * h + v * v + n * n);
  state.tension_at_sprocket_n = std::sqrt(h * h + vb * vb + nb * nb);
  state.angle_rad = std::atan2(vb, h);
  state.free_length_mm = s;
  state.wrap_mm = m.wrap(state.angle_rad);
  return state;
}

/// The chains with the unknowns moved in answer to loads, one for each derivative of the inputs.
template <bool kRotates, int N>
PerSide<ChainNumbers<N>> moved_chains(const EquilibriumConstants& m, const Pose& pose,
                                      const ChainInputs<Dual<N>>& inputs,
                                      const std::array<EquilibriumLoad, N>& loads) {
  const Unknowns<double> q = unknowns_of(pose);
  const PerSide<ChainTerms> t = terms_of(m, q);
  Unknowns<Dual<N>> moved = hanging::fixed<N>(q);
  for (std::size_t k = 0; k < N; ++k) {
    const Unknowns<double> d = solve_linearised<kRotates>(m, t, loads[k], q[kTurn]);
    for (std::size_t i = 0; i < d.size(); ++i) moved[i].d[k] = d[i];
  }
  return chains_at(m, inputs, moved);
}

/// Newton on (1) and (2) from `q`. \returns iterations, or 0 if it did not converge.
template <bool kRotates>
int converge_inverse(const EquilibriumConstants& m, BedPoint p, Unknowns<double>& q) {
  for (int n = 1; n <= hanging::kMostSteps; ++n) {
    const PerSide<ChainTerms> t = terms_of(m, q);
    Attachments a;
    if constexpr (kRotates) a = attachments(m, q[kTurn]);
    EquilibriumLoad residual;
    residual.u = {t.left.tip_u - (p.x_mm + a.left_x - m.motors.left.x_mm),
                  t.right.tip_u - (m.motors.right.x_mm - p.x_mm - a.right_x)};
    residual.y = {t.left.tip_y - (m.motors.left.y_mm - p.y_mm - a.left_y),
                  t.right.tip_y - (m.motors.right.y_mm - p.y_mm - a.right_y)};
    if constexpr (kRotates) residual.moment = moment_about_bit(m, a, t, q[kTurn]);
    const Unknowns<double> step = solve_linearised<kRotates>(m, t, residual, q[kTurn]);
    if (!hanging::are_finite(step)) return 0;
    if (hanging::advance({m.W, m.f}, step, q)) return n;
  }
  return 0;
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
    m.rotates = true;
  }
  m.W = parameters.sled_weight_n;
  m.k = parameters.beam_flexibility_mm_per_n;
  m.f = parameters.side_force_n;
  m.chain = {parameters.chain_weight_n_per_mm, parameters.chain_compliance_per_n};
  return m;
}

Pose pose_of(const EquilibriumConstants& m, const Unknowns<double>& q, BedPoint place,
             int iterations) {
  Pose pose;
  pose.position = place;
  pose.sled_rotation_rad = q[kTurn];
  pose.chains = {chain_state(m, q[kH], q[kV], q[kNLeft], q[kSLeft]),
                 chain_state(m, q[kH] - m.f, m.W - q[kV], q[kNRight], q[kSRight])};
  for (const Side side : kSides) {
    const ChainState& chain = pose.chains[side];
    pose.lengths[side] = chain.wrap_mm + chain.free_length_mm;
  }
  pose.iterations = iterations;
  return pose;
}

namespace {

/// \tparam kRotates brackets: the sled's rotation is an unknown.
template <bool kRotates>
class EquilibriumKinematics final : public Kinematics {
 public:
  EquilibriumKinematics(const EquilibriumParameters& parameters, const NotModelled& not_modelled)
      : m_(equilibrium_constants(parameters)), not_modelled_(not_modelled) {}

  [[nodiscard]] PoseResult inverse(BedPoint point) const override {
    if (const auto failure = domain_failure(limits_of(m_), point)) return tl::unexpected(*failure);
    Unknowns<double> q;
    const int iterations = converge_from_start(
        m_, point, q,
        [this](BedPoint p, Unknowns<double>& at) { return converge_inverse<kRotates>(m_, p, at); });
    if (iterations == 0) return tl::unexpected(why_not_converged(m_, point));
    return pose_of(m_, q, point, iterations);
  }

  [[nodiscard]] PoseResult forward(ChainLengths lengths) const override {
    const DomainLimits limits = limits_of(m_);
    const CircleGuess guess = circle_guess(limits, lengths);
    if (guess.hopeless || !guess.circles_meet) return forward_by_inverse(*this, limits, lengths);
    Unknowns<double> q = straight_start(m_, guess.point);
    const double span = m_.motors.right.x_mm - m_.motors.left.x_mm;
    const double rise = m_.motors.left.y_mm - m_.motors.right.y_mm;
    for (int n = 1; n <= hanging::kMostSteps; ++n) {
      const PerSide<ChainTerms> t = terms_of(m_, q);
      Attachments a;
      if constexpr (kRotates) a = attachments(m_, q[kTurn]);
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
      const Row l = row(t.left, q[kSLeft], lengths.left_mm);
      const Row r = row(t.right, q[kSRight], lengths.right_mm);
      // Both chains end at the same sled, across and in height.
      const double cx = l.u + r.u - a.left_x + a.right_x - span;
      const double cy = l.y - r.y + a.left_y - a.right_y - rise;
      SledRow moment;
      if constexpr (kRotates)
        moment = moment_row(m_, a, t, q[kTurn], moment_about_bit(m_, a, t, q[kTurn]));
      Unknowns<double> step =
          solve_sled<kRotates>({l.u_h + r.u_h, l.u_v - r.u_v, a.left_y - a.right_y, cx},
                               {l.y_h - r.y_h, l.y_v + r.y_v, a.left_x - a.right_x, cy}, moment);
      step[kSLeft] = l.s + l.s_h * step[kH] + l.s_v * step[kV];
      step[kSRight] = r.s + r.s_h * step[kH] - r.s_v * step[kV];
      if (!hanging::are_finite(step)) break;
      if (!hanging::advance({m_.W, m_.f}, step, q)) continue;
      const PerSide<ChainTerms> end = terms_of(m_, q);
      if constexpr (kRotates) a = attachments(m_, q[kTurn]);
      // Left and right are equal to rounding; their mean keeps the mirror symmetry exact.
      const BedPoint p{0.5 * (m_.motors.left.x_mm + end.left.tip_u - a.left_x +
                              (m_.motors.right.x_mm - end.right.tip_u - a.right_x)),
                       0.5 * (m_.motors.left.y_mm - end.left.tip_y - a.left_y +
                              (m_.motors.right.y_mm - end.right.tip_y - a.right_y))};
      if (domain_failure(limits, p)) break;
      return pose_of(m_, q, p, n);
    }
    return forward_by_inverse(*this, limits, lengths);
  }

  PerSide<ChainNumbers<2>> by_place(const Pose& pose) const override {
    EquilibriumLoad by_x, by_y;
    by_x.u = {-1.0, 1.0};
    by_y.y = {1.0, 1.0};
    return moved_chains<kRotates, 2>(m_, pose, inputs_by_place(m_, pose.position),
                                     std::array{by_x, by_y});
  }

  PerSide<ChainNumbers<1>> by_parameter(const Pose& pose, Parameter parameter) const override {
    const bool neglected =
        (parameter == Parameter::sprocket_radius_mm && not_modelled_.sprocket) ||
        (parameter == Parameter::chain_weight_n_per_mm && not_modelled_.chain_weight) ||
        (parameter == Parameter::chain_compliance_per_n && not_modelled_.compliance);
    const ChainInputs<Dual<1>> inputs =
        inputs_by_parameter(m_, pose.position, parameter, !neglected);
    EquilibriumLoad load;
    if (parameter <= Parameter::motor_right_y_mm) {
      // A motor's place enters (1) directly.
      for (const Side side : kSides) {
        const auto motor = inputs.to_motor(side);
        load.u[side] = -motor[0].d[0];
        load.y[side] = -motor[1].d[0];
      }
    } else {
      const auto left =
          hanging::slopes_of(residual(m_, inputs, hanging::fixed<1>(unknowns_of(pose))));
      load = {{left[0], left[3]}, {left[1], left[4]}, left[6]};
    }
    return moved_chains<kRotates, 1>(m_, pose, inputs, std::array{load});
  }

 private:
  EquilibriumConstants m_;
  NotModelled not_modelled_;
};

}  // namespace

std::unique_ptr<const Kinematics> make_equilibrium_kinematics(EquilibriumParameters p,
                                                              const NotModelled& not_modelled) {
  if (not_modelled.sprocket) p.sprocket_radius_mm = 0.0;
  if (not_modelled.chain_weight) p.chain_weight_n_per_mm = 0.0;
  if (not_modelled.compliance) p.chain_compliance_per_n = 0.0;
  if (std::holds_alternative<Ring>(p.attachment)) {
    return std::make_unique<EquilibriumKinematics<false>>(p, not_modelled);
  }
  return std::make_unique<EquilibriumKinematics<true>>(p, not_modelled);
}

}  // namespace chaintrue::model
