// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/formula_kinematics.hpp"

#include <cmath>
#include <stdexcept>

#include "model/forward_fallback.hpp"

namespace chaintrue::model {

FormulaKinematics::FormulaKinematics(const EquilibriumParameters& parameters,
                                     Formula formula,
                                     const Tolerances& tolerance)
    : parameters_(parameters), formula_(formula), tolerance_(tolerance) {
  const auto* ring = std::get_if<Ring>(&parameters.attachment);
  if (ring == nullptr) {
    throw std::invalid_argument("a closed formula for the chains needs a ring sled, not brackets");
  }
  // The straight line has no sprocket.
  if (formula == Formula::straight) parameters_.sprocket_radius_mm = 0.0;
  limits_ = {parameters_.motors,
             parameters_.sprocket_radius_mm,
             parameters_.feed == Feed::over_top ? 1.0 : -1.0,
             ring->radius_mm};
}

template <class T>
FormulaInputs<T> FormulaKinematics::inputs(BedPoint p) const {
  FormulaInputs<T> in;
  in.u_left_mm = p.x_mm - parameters_.motors.left.x_mm;
  in.y_left_mm = parameters_.motors.left.y_mm - p.y_mm;
  in.u_right_mm = parameters_.motors.right.x_mm - p.x_mm;
  in.y_right_mm = parameters_.motors.right.y_mm - p.y_mm;
  in.sprocket_radius_mm = parameters_.sprocket_radius_mm;
  in.ring_radius_mm = limits_.ring_radius_mm;
  in.sled_weight_n = parameters_.sled_weight_n;
  in.chain_weight_n_per_mm = parameters_.chain_weight_n_per_mm;
  in.compliance_per_n = parameters_.chain_compliance_per_n;
  in.feed_sign = limits_.feed_sign;
  return in;
}

template <class T>
FormulaLengths<T> FormulaKinematics::lengths(const FormulaInputs<T>& in) const {
  switch (formula_) {
    case Formula::straight:
      return straight_lengths(in);
    case Formula::wrap:
      return wrap_lengths(in);
    case Formula::firmware:
      return firmware_lengths(in, parameters_.sag_correction, tolerance_);
    case Formula::one_shot:
      break;
  }
  return one_shot_lengths(in, tolerance_);
}

PoseResult FormulaKinematics::inverse(BedPoint p) const {
  if (const auto failure = domain_failure(limits_, p)) return tl::unexpected(*failure);
  const FormulaInputs<double> in = inputs<double>(p);
  const auto l = straight_chain(in.u_left_mm, in.y_left_mm, in.sprocket_radius_mm, in.feed_sign);
  const auto r = straight_chain(in.u_right_mm, in.y_right_mm, in.sprocket_radius_mm, in.feed_sign);
  const double cl = std::cos(l.angle_rad), cr = std::cos(r.angle_rad);
  const double sine = std::sin(l.angle_rad + r.angle_rad);
  if (!(sine > 0.0)) return tl::unexpected(PoseReason::above_sprockets);
  // Sled's balance with straight chains: T_left cl - T_right cr = f, T_left sin + T_right sin = W.
  const double f = parameters_.side_force_n, weight = parameters_.sled_weight_n;
  const double tl_n = (weight * cr + f * std::sin(r.angle_rad)) / sine;
  const double tr_n = (weight * cl - f * std::sin(l.angle_rad)) / sine;
  if (!(tl_n > 0.0 && tr_n > 0.0)) return tl::unexpected(PoseReason::slack);
  const FormulaLengths<double> total = lengths(in);
  Pose pose;
  pose.position = p;
  pose.lengths = {total.left_mm, total.right_mm};
  const auto state = [](const StraightChain<double>& chain, double tension, double length) {
    ChainState s;
    s.horizontal_n = tension * std::cos(chain.angle_rad);
    s.vertical_at_sled_n = tension * std::sin(chain.angle_rad);
    s.tension_at_sled_n = s.tension_at_sprocket_n = tension;
    s.angle_rad = chain.angle_rad;
    s.wrap_mm = chain.wrap_mm;
    s.free_length_mm = length - chain.wrap_mm;
    return s;
  };
  pose.chains = {state(l, tl_n, total.left_mm), state(r, tr_n, total.right_mm)};
  if (formula_ == Formula::straight) {
    // A line to the axis has no arc, whichever the feed.
    for (const Side side : kSides) {
      pose.chains[side].wrap_mm = 0.0;
    }
  }
  return pose;
}

PoseResult FormulaKinematics::forward(ChainLengths lengths) const {
  if (!(lengths.left_mm > 0.0 && lengths.right_mm > 0.0 && std::isfinite(lengths.left_mm) &&
        std::isfinite(lengths.right_mm))) {
    return tl::unexpected(PoseReason::too_short);
  }
  return forward_by_inverse(*this, limits_, lengths);
}

Eigen::Matrix2d FormulaKinematics::jacobian(const Pose& pose) const {
  using D = Dual<2>;
  FormulaInputs<D> in = inputs<D>(pose.position);
  in.u_left_mm.d = {1.0, 0.0};
  in.u_right_mm.d = {-1.0, 0.0};
  in.y_left_mm.d = in.y_right_mm.d = {0.0, -1.0};
  const FormulaLengths<D> l = lengths(in);
  Eigen::Matrix2d j;
  j << l.left_mm.d[0], l.left_mm.d[1], l.right_mm.d[0], l.right_mm.d[1];
  return j;
}

Eigen::Vector2d FormulaKinematics::sensitivity(const Pose& pose, Parameter parameter) const {
  using D = Dual<1>;
  FormulaInputs<D> in = inputs<D>(pose.position);
  switch (parameter) {
    case Parameter::motor_left_x_mm:
      in.u_left_mm.d = {-1.0};
      break;
    case Parameter::motor_left_y_mm:
      in.y_left_mm.d = {1.0};
      break;
    case Parameter::motor_right_x_mm:
      in.u_right_mm.d = {1.0};
      break;
    case Parameter::motor_right_y_mm:
      in.y_right_mm.d = {1.0};
      break;
    case Parameter::ring_radius_mm:
      in.ring_radius_mm.d = {1.0};
      break;
    case Parameter::sprocket_radius_mm:
      if (formula_ == Formula::straight) return Eigen::Vector2d::Zero();
      in.sprocket_radius_mm.d = {1.0};
      break;
    case Parameter::sled_weight_n:
      in.sled_weight_n.d = {1.0};
      break;
    case Parameter::chain_weight_n_per_mm:
      in.chain_weight_n_per_mm.d = {1.0};
      break;
    case Parameter::chain_compliance_per_n:
      in.compliance_per_n.d = {1.0};
      break;
    case Parameter::beam_flexibility_mm_per_n:
    case Parameter::side_force_n:
      return Eigen::Vector2d::Zero();
  }
  const FormulaLengths<D> l = lengths(in);
  return {l.left_mm.d[0], l.right_mm.d[0]};
}

}  // namespace chaintrue::model
