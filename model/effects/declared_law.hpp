// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A declared effect with its parsed formulas, and what these give. Private to model/effects.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model/effects/declared_effect.hpp"

namespace chaintrue::model::effects {

/// A value that a formula may use besides the parameters.
struct FormulaVariable {
  std::string_view name;
  FormulaUnit unit;
  Number (*of)(const LengthState&) = nullptr;
  PlaceVariable place = PlaceVariable::none;
};
/// Of what acts on the paper x_mm and y_mm of the state are the mark's.
[[nodiscard]] std::span<const FormulaVariable> variables_of(ActsOn acts_on);
/// All values of a formula of this declaration, the parameters first; of an elongation these alone.
[[nodiscard]] std::vector<FormulaName> names_of(const Declaration& declaration, bool elongation);
/// What the formulas of such a declaration are evaluated for, in the order of names_of().
[[nodiscard]] std::vector<Number> values_at(ActsOn acts_on,
                                            const LengthState& state,
                                            Values parameters);

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
  /// Empty if not stated.
  [[nodiscard]] const std::optional<Formula>& adds() const { return adds_; }
  [[nodiscard]] const std::optional<Formula>& adds_x() const { return adds_x_; }
  [[nodiscard]] const std::optional<Formula>& adds_y() const { return adds_y_; }
  [[nodiscard]] const std::optional<Formula>& elongation() const { return elongation_; }
  [[nodiscard]] Number value(const std::optional<Formula>& formula,
                             const LengthState& state,
                             Values parameters) const;
  /// A formula of this effect uses the value of this name.
  [[nodiscard]] bool uses(std::string_view name) const;

 private:
  void describe();
  void connect();

  Declaration declaration_;
  std::vector<EffectSide> sides_;
  std::optional<Formula> adds_, adds_x_, adds_y_, elongation_;
  std::string equation_;
  Effect effect_;
};

}  // namespace chaintrue::model::effects
