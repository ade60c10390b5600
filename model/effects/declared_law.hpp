// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A declared effect with its parsed formulas, and what these give. Private to model/effects.
///
/// Values of a formula stand in this order: the parameters; then of a chain phi, S, L0, T, H, x, y,
/// which have derivatives, turn, pitch, r, d and side; of the paper x, y; of a reading n, pitch.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "model/effects/declared_effect.hpp"

namespace chaintrue::model::effects {

/// phi, S, L0, T, H, x, y.
inline constexpr int kChainSlopes = 7;
using ChainDual = Dual<kChainSlopes>;
inline constexpr std::size_t kMostParameters = 2;

/// The values that a formula may use besides the parameters, in their order.
[[nodiscard]] std::vector<FormulaName> variables_of(ActsOn acts_on);
/// All values of a formula of this declaration; of an elongation the parameters alone.
[[nodiscard]] std::vector<FormulaName> names_of(const Declaration& declaration, bool elongation);

/// Where a formula is evaluated.
struct ChainValues {
  std::array<ChainDual, kMostParameters + 12> all;
  std::size_t count = 0;
  [[nodiscard]] std::span<const ChainDual> span() const { return {all.data(), count}; }
};
[[nodiscard]] ChainValues values_of(const ChainAtRest& chain, double direction, Values parameters);
[[nodiscard]] ChainValues values_of(const VisitNote& visit, Values parameters);
[[nodiscard]] ChainValues values_of(const MarkPoint& mark, Values parameters);
[[nodiscard]] ChainValues values_of(Values parameters);

/// The chapter of docs/effects.md on effects that a user declares.
[[nodiscard]] std::string_view declared_chapter();

class DeclaredLaw {
 public:
  /// \throws std::invalid_argument where a formula has a problem.
  explicit DeclaredLaw(const Declaration& declaration);
  DeclaredLaw(const DeclaredLaw&) = delete;
  DeclaredLaw& operator=(const DeclaredLaw&) = delete;

  [[nodiscard]] const Declaration& declaration() const { return declaration_; }
  [[nodiscard]] const Effect& effect() const { return effect_; }
  /// Formulas that are not stated are empty.
  [[nodiscard]] const std::optional<Formula>& adds() const { return adds_; }
  [[nodiscard]] const std::optional<Formula>& adds_x() const { return adds_x_; }
  [[nodiscard]] const std::optional<Formula>& adds_y() const { return adds_y_; }
  [[nodiscard]] const std::optional<Formula>& elongation() const { return elongation_; }
  /// A formula of this effect uses the value of this name.
  [[nodiscard]] bool uses(std::string_view name) const;

 private:
  void describe();
  void connect();

  Declaration declaration_;
  std::vector<EffectSide> sides_;
  std::vector<EffectParameter> parameters_;
  std::optional<Formula> adds_, adds_x_, adds_y_, elongation_;
  std::string equation_;
  Effect effect_;
};

}  // namespace chaintrue::model::effects
