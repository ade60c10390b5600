// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Kinematics from a closed formula for a ring sled: straight line, wrap, the firmware's chain of
/// formulas, the one-shot catenary. Derivatives are exact (dual.hpp). Tensions in the pose are
/// those of straight weightless chains along the formula's angles.
#pragma once

#include "model/chain_equations.hpp"
#include "model/chain_formulas.hpp"

namespace chaintrue::model {

enum class Formula { straight, wrap, firmware, one_shot };

class FormulaKinematics final : public Kinematics {
 public:
  /// \param tolerance_percent of the firmwares, which divide the straight part by 1 + tolerance / 100
  /// \throws std::invalid_argument for brackets: the closed formulas have no rotating sled.
  FormulaKinematics(const EquilibriumParameters& parameters,
                    Formula formula,
                    const PerSide<double>& tolerance_percent = {});
  [[nodiscard]] PoseResult inverse(BedPoint point) const override;
  [[nodiscard]] PoseResult forward(ChainLengths lengths) const override;
  [[nodiscard]] PerSide<ChainNumbers<2>> by_place(const Pose& pose) const override;
  /// Lengths do not depend on parameters that are not in the formula: the firmware's sag factor is a
  /// separate number, not a weight.
  [[nodiscard]] PerSide<ChainNumbers<1>> by_parameter(const Pose& pose,
                                                      Parameter parameter) const override;

 private:
  template <class T>
  [[nodiscard]] PerSide<StraightChain<T>> straight_chains(const ChainInputs<T>& in) const;
  template <class T>
  [[nodiscard]] PerSide<T> lengths(const ChainInputs<T>& in) const;
  template <int N>
  [[nodiscard]] PerSide<ChainNumbers<N>> chains(const ChainInputs<Dual<N>>& in) const;

  EquilibriumConstants m_;
  Formula formula_;
  double sag_correction_;
  PerSide<double> tolerance_percent_;
};

}  // namespace chaintrue::model
