// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An effect of the catalogue: texts, parameters and one pure function in one constant.
///
/// A reading is computed in four stages, and each effect acts at exactly one of them:
///
///   paper     the mark is not where it is assumed to be     `write`
///   machine   geometry and forces of the equilibrium        `alter`
///   chain     what is paid out: added to a chain,           `add`, `add_by_direction`
///             in the catalogue's order, and at last
///             the length of the counted links               `elongation`
///   reading   what is written down                          `misread`
///
/// Of the six functions an effect sets exactly one. A new effect is one file that defines its
/// constant and one line in effects.def; a line without its file does not link, and the contract
/// suite runs over the table. A user declares an effect in a file: declared_effect.hpp.
///
/// Symbols used by the equations of the catalogue, i = left or right:
///   phi_i  angle of the chain below the horizontal where it leaves the sprocket [rad]
///   T_i    tension there [N]
///   H_i    its horizontal part [N]
///   S_i    free unstretched chain [mm]
///   L0_i   wrap + S, unstretched chain past 12 o'clock [mm]
///   n      number of the visit (`order`)
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "model/kinematics.hpp"

namespace chaintrue::model::effects {

enum class Station { paper, machine, chain, reading };

/// What an effect acts on: the machine as a whole, a chain (or both, with one shared value), an
/// axis of the paper, or a belt of four (or all).
enum class EffectSide { none, left, right, both, x, y, tl, tr, bl, br, all };

enum class RemedyKind { change_the_machine, correct_the_data, repair, compensate_on_its_own };

/// What a grid must hold for the effect to be observable.
enum class DataNeed { positions, order };

enum class ParameterRole {
  size,   ///< the effect vanishes as it goes to `null`
  place,  ///< where or when the effect sets in; has no meaning while the size is null
};

struct EffectParameter {
  /// Ends in its unit; the identifier in files and on the command line.
  std::string_view name;
  std::string_view symbol;
  std::string_view meaning;
  ParameterRole role = ParameterRole::size;
  /// The value without effect. For a place: any value, the nominal one.
  double null = 0.0;
  double nominal = 0.0;
  /// Range allowed in files: poses over the bed of a common machine are finite.
  double lower = 0.0;
  double upper = 0.0;
  /// Usual size, one sigma about null (about nominal for a place).
  double prior_sigma = 0.0;
  bool integer = false;
  /// -1 where the mirror image of the machine has the negative value.
  double mirror_sign = 1.0;
};

/// The parameters' values, in the order in which the effect lists them.
using Values = std::span<const double>;

/// One chain of the equilibrium, with every machine effect on.
struct ChainAtRest {
  ChainState state;
  double length_mm = 0.0;  ///< L0
  double turn_mm = 0.0;    ///< teeth * pitch: what one turn of the sprocket pays out
  double pitch_mm = 0.0;
  BedPoint position;  ///< of the tool
  double side = 1.0;  ///< 1 of the left chain, -1 of the right
};
[[nodiscard]] inline ChainAtRest chain_at_rest(const Pose& pose,
                                               Side side,
                                               double turn_mm,
                                               double pitch_mm) {
  return {pose.chains[side],
          pose.lengths[side],
          turn_mm,
          pitch_mm,
          pose.position,
          side == Side::left ? 1.0 : -1.0};
}

/// The change of a chain's length, and its derivatives by what effects depend on.
struct ChainAddition {
  double length_mm = 0.0;
  double per_angle_mm_per_rad = 0.0;     ///< d/d phi
  double per_free_length = 0.0;          ///< d/d S
  double per_length = 0.0;               ///< d/d L0
  double per_tension_mm_per_n = 0.0;     ///< d/d T
  double per_horizontal_mm_per_n = 0.0;  ///< d/d H
  double per_x = 0.0;                    ///< d/d x of the tool, the chain's state held
  double per_y = 0.0;
};

/// What the written reading depends on besides the lengths.
struct VisitNote {
  int order = 0;          ///< n
  double pitch_mm = 0.0;  ///< nominal, of the sprocket
};

/// What a declared effect is made of (declared_effect.hpp).
class DeclaredLaw;

/// A function of an effect: one of the catalogue's, or the formula of a declared effect. Equal to
/// nullptr where the effect has none.
template <class Signature>
class EffectFunction;

template <class Result, class... Arguments>
class EffectFunction<Result(Arguments...)> {
 public:
  using OfCatalogue = Result (*)(Arguments...);
  using OfFormula = Result (*)(const DeclaredLaw&, Arguments...);

  constexpr EffectFunction(std::nullptr_t = nullptr) {}  // NOLINT(google-explicit-constructor)
  constexpr EffectFunction(OfCatalogue function)         // NOLINT(google-explicit-constructor)
      : of_catalogue_(function) {}
  /// `law` must outlive it.
  constexpr EffectFunction(const DeclaredLaw& law, OfFormula function)
      : of_formula_(function), law_(&law) {}

  Result operator()(Arguments... arguments) const {
    return law_ != nullptr ? of_formula_(*law_, arguments...) : of_catalogue_(arguments...);
  }
  friend constexpr bool operator==(const EffectFunction& function, std::nullptr_t) {
    return function.of_catalogue_ == nullptr && function.law_ == nullptr;
  }

 private:
  OfCatalogue of_catalogue_ = nullptr;
  OfFormula of_formula_ = nullptr;
  const DeclaredLaw* law_ = nullptr;
};

struct Effect {
  std::string_view id;
  Station station = Station::paper;
  std::span<const EffectSide> sides;
  std::span<const EffectParameter> parameters;

  std::string_view cause;      ///< what is wrong with the machine or the data
  std::string_view signature;  ///< what the user sees on the bed
  std::string_view equation;
  std::string_view source;
  std::string_view not_modelled;
  std::string_view typical;  ///< usual size, in workshop units
  DataNeed needs = DataNeed::positions;
  RemedyKind remedy_kind = RemedyKind::repair;
  std::string_view remedy;  ///< what to do about it

  /// The written position of a mark whose true position is given.
  EffectFunction<MarkPoint(MarkPoint, EffectSide, Values)> write = nullptr;
  void (*alter)(EquilibriumParameters&, Values) = nullptr;
  EffectFunction<ChainAddition(const ChainAtRest&, Values)> add = nullptr;
  /// `direction` is +1 where the chain has been paid out to its length, -1 where it has been taken
  /// in. In mm.
  EffectFunction<double(double direction, Values)> add_by_direction = nullptr;
  /// e: a counted length is the true one divided by 1 + e, after all additions to the chain.
  EffectFunction<double(Values)> elongation = nullptr;
  /// In mm.
  EffectFunction<double(const VisitNote&, Values)> misread = nullptr;
  /// It acts only at the visit that its place parameter names.
  bool at_one_visit = false;
  /// Empty where the effect can act on such a machine, otherwise what it needs.
  std::string_view (*needs_machine)(const EquilibriumParameters&) = nullptr;
  /// Of a declared effect; null for those of the catalogue.
  const DeclaredLaw* law = nullptr;
};

[[nodiscard]] std::string_view name(Station station);
[[nodiscard]] std::string_view name(EffectSide side);  ///< "" for none
[[nodiscard]] std::string_view name(RemedyKind kind);
[[nodiscard]] std::string_view name(DataNeed need);

/// It depends on the visit and not on the point alone: drift, skips, hysteresis.
[[nodiscard]] inline bool depends_on_visit(const Effect& effect) {
  return effect.add_by_direction != nullptr || effect.misread != nullptr;
}

/// Left becomes right and right left; the others stay.
[[nodiscard]] EffectSide mirrored(EffectSide side);
/// An effect at `effect_side` acts on this chain (none and both act on either).
[[nodiscard]] bool acts_on(EffectSide effect_side, Side chain);

}  // namespace chaintrue::model::effects
