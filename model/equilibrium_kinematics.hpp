// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Kinematics from the full equilibrium in the sheet's plane: ring or brackets, heavy elastic
/// chains, and as their limits inextensible and weightless ones. Equations and notation in
/// equilibrium.hpp.
#pragma once

#include "model/equilibrium.hpp"

namespace chaintrue::model {

/// For models that neglect a term: its parameter is zero and the lengths do not depend on it.
struct NotModelled {
  bool sprocket = false;
  bool chain_weight = false;
  bool compliance = false;
};

/// \tparam kRotates brackets: the sled's rotation is an unknown. Accuracy (inverse and forward,
/// against 40-digit tables): 1e-11 mm over the default bed, 1e-9 mm down to 23 mm below the beam
/// and 19 mm from a sprocket's vertical.
template <bool kRotates>
class EquilibriumKinematics final : public Kinematics {
 public:
  explicit EquilibriumKinematics(const EquilibriumParameters& parameters,
                                 const NotModelled& not_modelled = {})
      : m_(equilibrium_constants(parameters)), not_modelled_(not_modelled) {}
  [[nodiscard]] PoseResult inverse(BedPoint point) const override;
  [[nodiscard]] PoseResult forward(ChainLengths lengths) const override;
  [[nodiscard]] PerSide<ChainNumbers<2>> by_place(const Pose& pose) const override;
  [[nodiscard]] PerSide<ChainNumbers<1>> by_parameter(const Pose& pose,
                                                      Parameter parameter) const override;

 private:
  EquilibriumConstants m_;
  NotModelled not_modelled_;
};

extern template class EquilibriumKinematics<false>;
extern template class EquilibriumKinematics<true>;

}  // namespace chaintrue::model
