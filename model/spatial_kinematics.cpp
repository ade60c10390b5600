// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/spatial_kinematics.hpp"

#include "model/chain_equations.hpp"
#include "model/equilibrium_newton.hpp"
#include "model/forward_fallback.hpp"

namespace chaintrue::model {
namespace {

/// The equations at a place, as a function of the unknowns.
template <class T>
auto equations_at(const EquilibriumConstants& m, const ChainInputs<T>& inputs) {
  return [&m, inputs](const Unknowns<T>& q) { return residual(m, inputs, q); };
}

int converge_inverse(const EquilibriumConstants& m, BedPoint p, Unknowns<double>& q) {
  return hanging::converge(equations_at(m, ChainInputs<Dual<kUnknowns>>(m, p)), {m.W, m.f}, q);
}

/// The chains with derivatives by what the inputs have them.
template <int N>
PerSide<ChainNumbers<N>> moved_chains_in_space(const EquilibriumConstants& m, const Pose& pose,
                                               const ChainInputs<Dual<N>>& inputs) {
  return chains_at(
      m, inputs,
      hanging::with_derivatives<N>(equations_at(m, ChainInputs<Dual<kUnknowns>>(m, pose.position)),
                                   equations_at(m, inputs), unknowns_of(pose)));
}

class SpatialKinematics final : public Kinematics {
 public:
  explicit SpatialKinematics(const EquilibriumParameters& parameters)
      : m_(equilibrium_constants(parameters)) {
    m_.cos_tilt = std::cos(parameters.tilt_rad);
    m_.sin_tilt = std::sin(parameters.tilt_rad);
  }

  [[nodiscard]] PoseResult inverse(BedPoint point) const override {
    if (const auto failure = domain_failure(limits_of(m_), point)) return tl::unexpected(*failure);
    Unknowns<double> q;
    const int iterations = converge_from_start(
        m_, point, q,
        [this](BedPoint p, Unknowns<double>& at) { return converge_inverse(m_, p, at); });
    if (iterations == 0) return tl::unexpected(why_not_converged(m_, point));
    return pose_of(m_, q, point, iterations);
  }
  [[nodiscard]] PoseResult forward(ChainLengths lengths) const override {
    return forward_by_inverse(*this, limits_of(m_), lengths);
  }
  PerSide<ChainNumbers<2>> by_place(const Pose& pose) const override {
    return moved_chains_in_space(m_, pose, inputs_by_place(m_, pose.position));
  }
  PerSide<ChainNumbers<1>> by_parameter(const Pose& pose, Parameter parameter) const override {
    return moved_chains_in_space(m_, pose, inputs_by_parameter(m_, pose.position, parameter));
  }

 private:
  EquilibriumConstants m_;
};

}  // namespace

std::unique_ptr<const Kinematics> make_spatial_kinematics(const EquilibriumParameters& parameters) {
  return std::make_unique<SpatialKinematics>(parameters);
}

}  // namespace chaintrue::model
