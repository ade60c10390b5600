// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A declared effect with its parsed formulas, and their values. Private to model/effects.
#pragma once

#include <array>
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
/// For an effect of the paper, x_mm and y_mm of the state are those of the mark.
std::span<const FormulaVariable> variables_of(ActsOn acts_on);
/// A formula of a declaration, in the order of kFormulas.
enum class FormulaKey { adds_mm, adds_x_mm, adds_y_mm, elongation };
struct FormulaRow {
  FormulaKey key;
  std::string_view name;  ///< in files
  const std::string Declaration::*text;
};
inline constexpr std::array kFormulas = {
    FormulaRow{FormulaKey::adds_mm, "adds_mm", &Declaration::adds_mm},
    FormulaRow{FormulaKey::adds_x_mm, "adds_x_mm", &Declaration::adds_x_mm},
    FormulaRow{FormulaKey::adds_y_mm, "adds_y_mm", &Declaration::adds_y_mm},
    FormulaRow{FormulaKey::elongation, "elongation", &Declaration::elongation}};

/// The names of all values of a formula of this declaration, the parameters first; an elongation
/// uses parameters alone.
std::vector<FormulaName> names_of(const Declaration& declaration, FormulaKey key);
[[nodiscard]] tl::expected<Formula, FormulaProblem> parsed(const Declaration& declaration,
                                                           const FormulaRow& row);
/// The values for which the formulas of such a declaration are evaluated, in the order of
/// names_of().
std::vector<Number> values_at(ActsOn acts_on, const LengthState& state, Values parameters);

/// The chapter of docs/effects.md on effects that a user declares.
std::string_view declared_chapter();

class DeclaredLaw {
 public:
  /// \throws std::invalid_argument if a formula has a problem.
  explicit DeclaredLaw(const Declaration& declaration);
  DeclaredLaw(const DeclaredLaw&) = delete;
  DeclaredLaw& operator=(const DeclaredLaw&) = delete;

  const Declaration& declaration() const { return declaration_; }
  const Effect& effect() const { return effect_; }
  /// Empty if not stated.
  const std::optional<Formula>& formula(FormulaKey key) const {
    return formulas_[static_cast<std::size_t>(key)];
  }
  Number value(FormulaKey key, const LengthState& state, Values parameters) const;
  /// Whether a formula of this effect uses the value with this name.
  bool uses(std::string_view name) const;

 private:
  void describe();
  void connect();

  Declaration declaration_;
  std::vector<EffectSide> sides_;
  std::array<std::optional<Formula>, kFormulas.size()> formulas_;
  std::string equation_;
  Effect effect_;
};

}  // namespace chaintrue::model::effects
