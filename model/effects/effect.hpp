// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An effect: something that may be wrong with a machine or its readings. Texts, parameters and one
/// pure function in one constant, for two chains, four belts and V-plotters alike.
///
/// A reading is computed in four stages, and each effect acts at exactly one of them:
///
///   paper     the mark is not where it is assumed to be     `write`
///   machine   geometry and forces of the equilibrium        `alter`, `alter_anchor`, `alter_cords`
///   chain     what is paid out: added to a length,          `add`
///             in the table's order, and at last
///             the length of the counted links               `elongation`
///   reading   what is written down                          `add`
///
/// An effect sets exactly one of these functions. The effects of a mechanism are a table:
/// chains/chain_effects.cpp, belts/belt_effects.cpp, plotter/plotter_effects.cpp; the contract suite
/// runs over each. A user declares an effect in a file: declared_effect.hpp.
///
/// Symbols used by the equations, i = a chain, a belt or a cord:
///   phi_i  angle of the chain below the horizontal where it leaves the sprocket [rad]
///   T_i    tension there [N]; of a belt over the pull that sizes refer to
///   H_i    its horizontal part [N]
///   S_i    free unstretched chain [mm]
///   L0_i   wrap + S, unstretched chain past 12 o'clock [mm]; L of a belt, slanting, and of a cord
///   n      number of the visit (`order`)
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>

#include "model/dual.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {
struct Anchor;
namespace plotter {
struct Statics;
}
}  // namespace chaintrue::model

namespace chaintrue::model::effects {

enum class Station { paper, machine, chain, reading };

/// What an effect acts on: the machine as a whole, a chain (or both, with one shared value), an
/// axis of the paper, or a belt of four (or all).
enum class EffectSide { none, left, right, both, x, y, tl, tr, bl, br, all };

enum class RemedyKind { change_the_machine, correct_the_data, repair, compensate_on_its_own };

/// The data that a grid must contain for the effect to be observable.
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
  /// -1 if mirroring the machine negates the value.
  double mirror_sign = 1.0;
};

/// The parameters' values, in the order in which the effect lists them.
using Values = std::span<const double>;

/// The parameters of an effect, sizes first.
class EffectParameters {
 public:
  static constexpr std::size_t kMost = 3;
  constexpr EffectParameters() = default;
  constexpr EffectParameters(std::initializer_list<EffectParameter> parameters) {
    for (const EffectParameter& parameter : parameters) push_back(parameter);
  }
  constexpr void push_back(const EffectParameter& parameter) { all_.at(count_++) = parameter; }
  constexpr const EffectParameter* begin() const { return all_.data(); }
  constexpr const EffectParameter* end() const { return begin() + count_; }
  constexpr std::size_t size() const { return count_; }
  constexpr bool empty() const { return count_ == 0; }
  constexpr const EffectParameter& operator[](std::size_t i) const { return all_[i]; }
  constexpr const EffectParameter& front() const { return all_[0]; }
  constexpr const EffectParameter& back() const { return all_[count_ - 1]; }

 private:
  std::array<EffectParameter, kMost> all_;
  std::size_t count_ = 0;
};

/// The variables on which the length of a chain, a belt or a cord may depend.
enum LengthVariable { kAngle, kFree, kLength, kTension, kHorizontal, kX, kY, kLengthVariables };
/// A number with its derivatives by these.
using Number = Dual<kLengthVariables>;
constexpr Number variable(double value, LengthVariable which) {
  return Number::variable(value, which);
}

/// A chain, a belt or a cord at a visit, with every machine effect on. Values that a mechanism does
/// not have are 0.
struct LengthState {
  Number angle_rad = {};        ///< phi
  Number free_mm = {};          ///< S
  Number length_mm = {};        ///< L0
  Number tension = {};          ///< T
  Number horizontal_n = {};     ///< H
  Number x_mm = {}, y_mm = {};  ///< of the tool, with the rest of the state fixed
  double turn_mm = 0.0;         ///< what one turn of the sprocket, pulley or spool pays out
  double tooth_mm = 0.0;        ///< for a chain, its nominal pitch
  double side = 1.0;            ///< 1 for the left one, -1 for the right
  double direction = 1.0;       ///< 1 if it was paid out to its length, -1 if it was taken in
  int order = 0;                ///< n
};
/// The state of a chain in equilibrium, without a visit.
LengthState chain_at_rest(const Pose& pose, Side side, const Sprocket& sprocket);

/// A part that a machine may lack.
enum class Part { none, ring, brackets, body, pulley };

/// A declared effect's formulas (declared_effect.hpp).
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

  constexpr EffectFunction() = default;
  template <std::convertible_to<OfCatalogue> Function>
  constexpr EffectFunction(Function function)  // NOLINT(google-explicit-constructor)
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

inline constexpr EffectSide kNoSide[] = {EffectSide::none};

/// What an effect does not state is that of most: a fault of the machine without a side, whose
/// number can be entered.
struct Effect {
  std::string_view id;
  Station station = Station::machine;
  std::span<const EffectSide> sides = kNoSide;
  EffectParameters parameters;

  std::string_view cause;      ///< the fault of the machine or the data
  std::string_view signature;  ///< its visible sign on the bed
  std::string_view equation;
  std::string_view source;
  std::string_view not_modelled;
  std::string_view typical;  ///< usual size, in workshop units
  DataNeed needs = DataNeed::positions;
  RemedyKind remedy_kind = RemedyKind::change_the_machine;
  std::string_view remedy;  ///< what to do about it

  /// The written position of a mark whose true position is given.
  EffectFunction<MarkPoint(MarkPoint, EffectSide, Values)> write = {};
  /// For two chains; for the anchor of a belt at visit `order`; for a plotter by the directions in
  /// which its cords moved.
  void (*alter)(EquilibriumParameters&, Values) = nullptr;
  void (*alter_anchor)(Anchor&, int order, Values) = nullptr;
  void (*alter_cords)(plotter::Statics&, EffectSide, const PerSide<double>&, Values) = nullptr;
  /// In mm.
  EffectFunction<Number(const LengthState&, Values)> add = {};
  /// e: a counted length is the true one divided by 1 + e, after all additions to the chain.
  EffectFunction<double(Values)> elongation = {};
  /// `add` depends on the direction, and on the parameters alone besides.
  bool by_direction = false;
  /// `add` is in proportion to the tension.
  bool by_tension = false;
  /// It acts only at the visit given by its place parameter.
  bool at_one_visit = false;
  /// The part that a machine needs for the effect to act on it.
  Part part = Part::none;
  /// For four belts: how often it acts, relative to the others.
  double share = 1.0;
  /// For four belts: the share of this effect among those that sound machines show as often as not;
  /// 0 for every other effect.
  double expected = 0.0;
  /// For a declared effect; null for those of the catalogue.
  const DeclaredLaw* law = nullptr;
};

std::string_view name(Station station);
std::string_view name(EffectSide side);  ///< "" for none
std::string_view name(RemedyKind kind);
std::string_view name(DataNeed need);
std::string_view name(Part part);  ///< in words: "a sled on a ring ..."

/// For two chains: whether it depends on the visit as well as on the point (drift, skips,
/// hysteresis).
inline bool depends_on_visit(const Effect& effect) {
  return effect.by_direction || effect.station == Station::reading;
}

/// Left becomes right and right left; the others stay.
EffectSide mirrored(EffectSide side);
/// Whether an effect at `effect_side` acts on this chain (none and both act on either).
bool acts_on(EffectSide effect_side, Side chain);

}  // namespace chaintrue::model::effects

/// Exported: these names are used throughout chaintrue.
namespace chaintrue {
using model::effects::DataNeed;
using model::effects::Effect;
using model::effects::EffectParameter;
using model::effects::EffectSide;
using model::effects::ParameterRole;
using model::effects::Station;
}  // namespace chaintrue
