// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/formula_kinematics.hpp"

#include <cmath>
#include <stdexcept>

#include "model/chain_equations.hpp"
#include "model/chain_formulas.hpp"
#include "model/equilibrium_newton.hpp"
#include "model/forward_fallback.hpp"

namespace chaintrue::model {

namespace {

/// The sled's balance with straight chains:
/// T_left cos - T_right cos = f, T_left sin + T_right sin = W.
template <class T>
PerSide<T> tensions(const ChainInputs<T>& in, const PerSide<StraightChain<T>>& chains) {
  using std::cos;
  using std::sin;
  const T &left = chains.left.angle_rad, &right = chains.right.angle_rad;
  const T& weight = in[Parameter::sled_weight_n];
  const T& side = in[Parameter::side_force_n];
  const T sine = sin(left + right);
  return {(weight * cos(right) + side * sin(right)) / sine,
          (weight * cos(left) - side * sin(left)) / sine};
}

class FormulaKinematics final : public Kinematics {
 public:
  FormulaKinematics(const EquilibriumParameters& parameters, Formula formula,
                    const PerSide<double>& tolerance_percent)
      : m_(equilibrium_constants(parameters)),
        formula_(formula),
        sag_correction_(parameters.sag_correction),
        tolerance_percent_(tolerance_percent) {
    if (m_.rotates) {
      throw std::invalid_argument(
          "a closed formula for the chains needs a ring sled, not brackets");
    }
    // The straight line has no sprocket: a wrap of radius 0.
    if (formula == Formula::straight) m_.r = 0.0;
  }

  [[nodiscard]] PoseResult inverse(BedPoint p) const override {
    if (const auto failure = domain_failure(limits_of(m_), p)) return tl::unexpected(*failure);
    const ChainInputs<double> in(m_, p);
    const PerSide<StraightChain<double>> chains = straight_chains(in);
    if (!(std::sin(chains.left.angle_rad + chains.right.angle_rad) > 0.0))
      return tl::unexpected(PoseReason::above_sprockets);
    const PerSide<double> tension = tensions(in, chains);
    if (!(tension.left > 0.0 && tension.right > 0.0)) return tl::unexpected(PoseReason::slack);
    const PerSide<double> total = lengths(in, chains);
    Pose pose;
    pose.position = p;
    for (const Side side : kSides) {
      const StraightChain<double>& chain = chains[side];
      ChainState& s = pose.chains[side];
      s.horizontal_n = tension[side] * std::cos(chain.angle_rad);
      s.vertical_at_sled_n = tension[side] * std::sin(chain.angle_rad);
      s.tension_at_sled_n = s.tension_at_sprocket_n = tension[side];
      s.angle_rad = chain.angle_rad;
      s.wrap_mm = chain.wrap_mm;
      s.free_length_mm = total[side] - chain.wrap_mm;
      pose.lengths[side] = total[side];
    }
    return pose;
  }

  [[nodiscard]] PoseResult forward(ChainLengths lengths) const override {
    return forward_by_inverse(*this, limits_of(m_), lengths);
  }

  PerSide<ChainNumbers<2>> by_place(const Pose& pose) const override {
    return chains(inputs_by_place(m_, pose.position));
  }

  Eigen::Matrix2d jacobian(const Pose& pose) const override {
    const auto in = inputs_by_place(m_, pose.position);
    const auto [left, right] = lengths(in, straight_chains(in));
    return Eigen::Matrix2d{{left.d[0], left.d[1]}, {right.d[0], right.d[1]}};
  }

  PerSide<ChainNumbers<1>> by_parameter(const Pose& pose, Parameter parameter) const override {
    const bool counts = parameter != Parameter::sprocket_radius_mm || formula_ != Formula::straight;
    return chains(inputs_by_parameter(m_, pose.position, parameter, counts));
  }

 private:
  template <class T>
  PerSide<StraightChain<T>> straight_chains(const ChainInputs<T>& in) const {
    PerSide<StraightChain<T>> chains;
    for (const Side side : kSides) {
      const auto [u, y] = in.to_motor(side);
      chains[side] = straight_chain(u, y, in[Parameter::sprocket_radius_mm], m_.sg);
    }
    return chains;
  }

  template <class T>
  PerSide<T> lengths(const ChainInputs<T>& in, const PerSide<StraightChain<T>>& chains) const {
    const auto free_length = [&](const StraightChain<T>& own, const StraightChain<T>& other) -> T {
      if (formula_ == Formula::firmware)
        return firmware_sagged_mm(own, other.angle_rad, sag_correction_);
      if (formula_ == Formula::one_shot) {
        return one_shot_mm(own, other, in[Parameter::sled_weight_n],
                           in[Parameter::chain_weight_n_per_mm],
                           in[Parameter::chain_compliance_per_n]);
      }
      return own.straight_mm;
    };
    PerSide<T> result{free_length(chains.left, chains.right),
                      free_length(chains.right, chains.left)};
    for (const Side side : kSides) {
      result[side] = chains[side].wrap_mm +
                     result[side] / (1.0 + tolerance_percent_[side] / 100.0) -
                     in[Parameter::ring_radius_mm];
    }
    return result;
  }

  template <int N>
  PerSide<ChainNumbers<N>> chains(const ChainInputs<Dual<N>>& in) const {
    const PerSide<StraightChain<Dual<N>>> straight = straight_chains(in);
    const PerSide<Dual<N>> total = lengths(in, straight), tension = tensions(in, straight);
    PerSide<ChainNumbers<N>> result;
    for (const Side side : kSides) {
      result[side] = {total[side], straight[side].angle_rad, total[side] - straight[side].wrap_mm,
                      tension[side], tension[side] * cos(straight[side].angle_rad)};
    }
    return result;
  }

  EquilibriumConstants m_;
  Formula formula_;
  double sag_correction_;
  PerSide<double> tolerance_percent_;
};

}  // namespace

std::unique_ptr<const Kinematics> make_formula_kinematics(
    const EquilibriumParameters& parameters, Formula formula,
    const PerSide<double>& tolerance_percent) {
  return std::make_unique<FormulaKinematics>(parameters, formula, tolerance_percent);
}

}  // namespace chaintrue::model
