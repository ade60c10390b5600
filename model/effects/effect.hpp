// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What an effect of the catalogue is: words, parameters and one pure function, all in one
/// constant.
///
/// A reading passes four stations, and each effect stands at exactly one of them:
///
///   paper     the mark is not where it is thought to be     `write`
///   machine   geometry and forces of the equilibrium        `alter`
///   chain     what is paid out: added to a chain,           `add`, `add_by_direction`
///             in the catalogue's order, and at last
///             the length of the counted links               `elongation`
///   reading   what is written down                          `misread`
///
/// Of the six functions an effect sets exactly one. A new effect is one file that defines its
/// constant and one line in effects.def; a line without its file does not link, and the contract
/// suite tests whatever the table lists.
///
/// Symbols used by the equations of the catalogue, i = left or right:
///   phi_i  angle of the chain below the horizontal where it leaves the sprocket [rad]
///   T_i    tension there [N]
///   H_i    its horizontal part [N]
///   S_i    free unstretched chain [mm]
///   L0_i   wrap + S, unstretched chain past 12 o'clock [mm]
///   n      number of the visit (`order`)
#pragma once

#include <span>
#include <string_view>

#include "model/kinematics.hpp"

namespace chaintrue::model::effects {

enum class Station { paper, machine, chain, reading };

/// What an effect may be said to act on: nothing in particular, a chain (or both, with one shared
/// value), an axis of the paper, or a belt of four (or all).
enum class EffectSide { none, left, right, both, x, y, tl, tr, bl, br, all };

enum class RemedyKind { change_the_machine, correct_the_data, repair, compensate_on_its_own };

/// What a grid must hold before the effect can be seen in it at all.
enum class DataNeed { positions, order };

enum class ParameterRole {
  size,   ///< the effect vanishes as it goes to `null`
  place,  ///< where or when the effect sets in; without meaning while the size is null
};

struct EffectParameter {
  /// Ends in its unit; the word of files and of the command line.
  std::string_view name;
  std::string_view symbol;
  std::string_view meaning;
  ParameterRole role = ParameterRole::size;
  /// Where nothing happens. For a place: any value, the nominal one.
  double null = 0.0;
  double nominal = 0.0;
  /// What a file may say; a value beyond is a slip. Finite poses over the bed of a common machine.
  double lower = 0.0;
  double upper = 0.0;
  /// How large it usually is, one sigma about null (about nominal for a place).
  double prior_sigma = 0.0;
  bool integer = false;
  /// -1 where the mirror image of the machine has the opposite value.
  double mirror_sign = 1.0;
};

/// The parameters' values, in the order in which the effect lists them.
using Values = std::span<const double>;

/// One chain of the equilibrium that has every machine effect on.
struct ChainAtRest {
  ChainState state;
  double length_mm = 0.0;  ///< L0
  double turn_mm = 0.0;    ///< teeth * pitch: what one turn of the sprocket pays out
};

/// What a chain gains, and how that changes with the three numbers that effects look at.
struct ChainAddition {
  double length_mm = 0.0;
  double per_angle_mm_per_rad = 0.0;  ///< d/d phi
  double per_free_length = 0.0;       ///< d/d S
  double per_length = 0.0;            ///< d/d L0
};

/// What a person's note depends on beside the lengths.
struct VisitNote {
  int order = 0;          ///< n
  double pitch_mm = 0.0;  ///< nominal, of the sprocket
};

struct Effect {
  std::string_view id;
  Station station = Station::paper;
  std::span<const EffectSide> sides;
  std::span<const EffectParameter> parameters;

  std::string_view cause;      ///< what is wrong with the machine or the data
  std::string_view signature;  ///< what a person sees on the bed
  std::string_view equation;
  std::string_view source;
  std::string_view not_modelled;
  std::string_view typical;  ///< usual size, in workshop units
  DataNeed needs = DataNeed::positions;
  RemedyKind remedy_kind = RemedyKind::repair;
  std::string_view remedy;  ///< what to do about it

  /// Where the mark is written that truly is at the point.
  MarkPoint (*write)(MarkPoint, EffectSide, Values) = nullptr;
  void (*alter)(EquilibriumParameters&, Values) = nullptr;
  ChainAddition (*add)(const ChainAtRest&, Values) = nullptr;
  /// `direction` is +1 where the chain has been paid out to get here, -1 where it has been taken
  /// in. In mm.
  double (*add_by_direction)(double direction, Values) = nullptr;
  /// e: a counted length is the true one divided by 1 + e, after everything that is added to the
  /// chain.
  double (*elongation)(Values) = nullptr;
  /// In mm.
  double (*misread)(const VisitNote&, Values) = nullptr;
  /// It acts at the visit of its place alone, not from there on.
  bool at_one_visit = false;
  /// Empty where the effect can act on such a machine, otherwise what it would need.
  std::string_view (*needs_machine)(const EquilibriumParameters&) = nullptr;
};

[[nodiscard]] std::string_view name(Station station);
[[nodiscard]] std::string_view name(EffectSide side);  ///< "" for none
[[nodiscard]] std::string_view name(RemedyKind kind);
[[nodiscard]] std::string_view name(DataNeed need);

/// Its place depends on the visit and not on the point alone: drift, skips, hysteresis.
[[nodiscard]] inline bool depends_on_visit(const Effect& effect) {
  return effect.add_by_direction != nullptr || effect.misread != nullptr;
}

/// Left becomes right and right left; the others stay.
[[nodiscard]] EffectSide mirrored(EffectSide side);
/// An effect at `effect_side` acts on this chain (none and both act on either).
[[nodiscard]] bool acts_on(EffectSide effect_side, Side chain);

}  // namespace chaintrue::model::effects
