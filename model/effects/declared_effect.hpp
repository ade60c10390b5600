// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An effect that a user declares in a file: its words, its parameters and a formula, made into an
/// Effect like those of the catalogue.
///
/// | acts on | formulas | what they may use besides the parameters |
/// |---|---|---|
/// | paper   | adds_x_mm, adds_y_mm | x, y of the mark; in proportion to them, as a tape or a skew acts |
/// | chain   | adds_mm | L0, S, phi, T, H, turn, pitch, x, y, r, side (symbols of effect.hpp; x, y, r the tool's place and its distance from the middle; side 1 of the left chain, -1 of the right); or d alone |
/// |         | elongation | nothing: counted length = true length / (1 + elongation) |
/// | reading | adds_mm | n, pitch |
/// | visit   | adds_mm | n, pitch; added at the visit that its place names and at no other |
///
/// d is +1 where a chain was paid out to its length, -1 where it was taken in. An effect has one
/// size, its first parameter, and one place at most, its second. Not modelled: what changes the
/// equilibrium (machine), a place of the tool that is shifted, more than one size.
///
/// \code
///   Declaration own;                     // files: grid/files/effect_file.hpp
///   if (problems_of(own).empty()) machine.declared.push_back(&declared_effect(own));
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/effects/effect.hpp"
#include "model/effects/formula.hpp"

namespace chaintrue::model::effects {

enum class ActsOn { paper, chain, reading, visit };

struct DeclaredParameter {
  std::string name;  ///< ends in its unit
  std::string symbol;
  std::string meaning;
  ParameterRole role = ParameterRole::size;
  double null = 0.0;
  double nominal = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  double prior_sigma = 0.0;
  bool integer = false;
  double mirror_sign = 1.0;
  friend bool operator==(const DeclaredParameter&, const DeclaredParameter&) = default;
};

/// The content of a file. Texts of missing formulas are empty.
struct Declaration {
  std::string id;
  /// The effect of the catalogue that it replaces; empty: it is added to the catalogue.
  std::string instead_of;
  ActsOn acts_on = ActsOn::chain;
  std::vector<EffectSide> sides;
  std::vector<DeclaredParameter> parameters;
  std::string adds_mm;
  std::string adds_x_mm;
  std::string adds_y_mm;
  std::string elongation;
  std::string cause;
  std::string signature;
  RemedyKind remedy_kind = RemedyKind::repair;
  std::string remedy;
  std::string not_modelled;
  std::string typical;
  std::string source;
  friend bool operator==(const Declaration&, const Declaration&) = default;
};

struct DeclarationProblem {
  std::string place;  ///< JSON pointer below the declaration: "/parameters/0/lower"
  std::string value;
  std::string expected;
  /// For a formula: offset into its text, in bytes.
  std::optional<std::size_t> offset{};
};

/// The unit that a parameter's name ends in: "amplitude_mm", "slope_mm_per_rad", "share". Empty for
/// a unit that formulas do not know, such as "_deg".
std::optional<FormulaUnit> unit_of_name(std::string_view name);

/// All problems of a declaration, without a machine.
[[nodiscard]] std::vector<DeclarationProblem> problems_of(const Declaration& declaration);
/// Whether its formulas are finite, and null at null, on the bed of this machine. Precondition:
/// problems_of(declaration) is empty.
[[nodiscard]] std::vector<DeclarationProblem> problems_on_bed(const Declaration& declaration,
                                                              const Machine& machine);

/// The declared effect. Like the catalogue's it lives as long as the program, because causes refer
/// to it. Equal declarations are one effect. \throws std::invalid_argument for a declaration whose
/// formulas have problems.
const Effect& declared_effect(const Declaration& declaration);
/// Null for an effect of the catalogue.
const Declaration* declaration_of(const Effect& effect);

/// The variable that a declared effect's place is compared with.
enum class PlaceVariable {
  none,
  visit,
  phase,
  angle,
  free_length,
  length,
  tension,
  horizontal,
  x,
  y,
  distance
};
/// Precondition: a declared effect with a place. The one variable of the place's unit that its
/// formula uses; empty for none or several.
PlaceVariable place_variable(const Effect& effect);

std::string_view name(ActsOn acts_on);

}  // namespace chaintrue::model::effects

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::effects::PlaceVariable;
}  // namespace chaintrue
