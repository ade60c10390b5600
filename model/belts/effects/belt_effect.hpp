// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An effect: something that may be wrong with a router on four belts or with its readings. Texts,
/// parameters and one pure function in one constant. A new effect is one file that defines it and one
/// line in belt_effects.def; the contract suite runs over the table.
///
/// A reading is computed in three stages, and each effect acts at one of them:
///
///   machine   where an anchor really is                                `alter`
///   belt      what the encoder counts in addition to the belt's length  `add`
///   print     the counted length in the controller's convention, with the arm, the extension and the
///             heights set in it                                        (belt_readings.hpp)
///
/// Symbols: L the belt's own length, slanting, mm; n the number of the visit; T the belt's tension at it,
/// over the pull that sizes refer to.
#pragma once

#include <span>
#include <string_view>

#include "model/belts/belt_machine.hpp"
#include "model/effects/effect.hpp"
#include "model/effects/sides.hpp"

namespace chaintrue::model::belts {

/// What an effect acts on: the machine as a whole, one belt, or all belts with one shared value.
using BeltSide = effects::EffectSide;
[[nodiscard]] bool acts_on(BeltSide side, Belt belt);

/// A belt at a visit.
struct BeltVisit {
  Belt belt = Belt::tl;
  /// Of all four, by their motors at the reading; the others hold.
  PerBelt<bool> pulled{};
  int order = 0;      ///< n
  double pull = 1.0;  ///< of the belts that are pulled, over the pull that sizes refer to
};

/// A belt at a reading, as `add` knows it.
struct BeltState {
  double length_mm = 0.0;  ///< L
  double turn_mm = 0.0;    ///< belt for a turn of its encoder
  double tension = 0.0;    ///< T, of belt_statics.hpp
};

using effects::Values;

struct BeltEffect {
  std::string_view id;
  std::span<const BeltSide> sides;
  std::span<const effects::EffectParameter> parameters;

  std::string_view cause;
  std::string_view signature;  ///< what it changes in the lengths, or on the sheet
  std::string_view equation;
  std::string_view source;
  std::string_view not_modelled;
  std::string_view typical;
  effects::DataNeed needs = effects::DataNeed::positions;
  effects::RemedyKind remedy_kind = effects::RemedyKind::repair;
  std::string_view remedy;

  /// The anchor of the visit's belt.
  void (*alter)(Anchor&, const BeltVisit&, Values) = nullptr;
  /// Counted less true, mm.
  double (*add)(const BeltState&, const BeltVisit&, Values) = nullptr;
  /// `add` depends on the tension; it is in proportion to it.
  bool by_tension = false;

  /// How often it acts, against the others.
  double share = 1.0;
  /// What machines in order do as often as not: its part of all that is expected; 0 of every other effect.
  double expected = 0.0;
};

inline constexpr BeltSide kNoBelt[] = {BeltSide::none};
inline constexpr BeltSide kOneBelt[] = {BeltSide::tl, BeltSide::tr, BeltSide::bl, BeltSide::br};
inline constexpr BeltSide kOneBeltOrAll[] = {
    BeltSide::tl, BeltSide::tr, BeltSide::bl, BeltSide::br, BeltSide::all};

#define CHAINTRUE_BELT_EFFECT(id) \
  namespace id##_effect {         \
  extern const BeltEffect id;     \
  }                               \
  using id##_effect::id;
#include "model/belts/effects/belt_effects.def"
#undef CHAINTRUE_BELT_EFFECT

/// In the order of the table.
[[nodiscard]] std::span<const BeltEffect* const> belt_effects();
/// Null where there is none of that name.
[[nodiscard]] const BeltEffect* find_belt_effect(std::string_view id);
/// Its texts, sides and parameters in the form of the chains' catalogue.
[[nodiscard]] const effects::Effect& described(const BeltEffect& effect);
/// All of them so, in the order of the table.
[[nodiscard]] std::span<const effects::Effect* const> described_belt_effects();
/// The effect with this description; null for one of the chains' catalogue.
[[nodiscard]] const BeltEffect* belt_effect_of(const effects::Effect& described);

/// The visit at which an effect sets in.
inline constexpr effects::EffectParameter kFirstVisit =
    effects::visit_parameter("first_visit", "number of the first visit at which it acts");

}  // namespace chaintrue::model::belts
