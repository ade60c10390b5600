// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An effect: something that may be wrong with a V-plotter. Texts and parameters (an Effect of
/// model/effects) and one pure function in one constant. A new effect is one file that defines it and
/// one line in plotter_effects.def; the contract suite runs over the table. What is a setting (the
/// pins' spacing and rise, zeros and scales) is a parameter of the mechanism and no effect.
///
/// A length is computed in two stages, and each effect acts at one of them:
///
///   machine   geometry and forces of the equilibrium       `alter`
///   cord      what is added to the cord's own length       `add`
///
/// Symbols: L a cord's unstretched length, mm; n the number of the visit; d of a cord, +1 where it
/// was paid out to get there and -1 where it was taken in.
#pragma once

#include <span>
#include <string_view>

#include "model/effects/effect.hpp"
#include "model/effects/sides.hpp"
#include "model/plotter/plotter_statics.hpp"

namespace chaintrue::model::plotter {

using effects::EffectParameter;
using effects::EffectSide;
using effects::Values;

/// A cord at a visit.
struct CordVisit {
  PerSide<double> direction{1.0, 1.0};  ///< d
  int order = 0;                        ///< n
  double turn_mm = 0.0;                 ///< cord of one turn of its pulley; 0: it has none
  double tooth_mm = 0.0;                ///< Cord::tooth_mm
};

struct PlotterEffect {
  effects::Effect described;
  void (*alter)(Statics&, EffectSide, const CordVisit&, Values) = nullptr;
  /// What is counted in addition to a cord at rest, mm.
  Number (*add)(const CordState<Number>&, const CordVisit&, Values) = nullptr;
  /// Empty where it can act on such a machine, otherwise what it needs.
  std::string_view (*needs)(const PlotterMachine&) = nullptr;
};

#define CHAINTRUE_PLOTTER_EFFECT(id) \
  namespace id##_effect {            \
  extern const PlotterEffect id;     \
  }                                  \
  using id##_effect::id;
#include "model/plotter/effects/plotter_effects.def"
#undef CHAINTRUE_PLOTTER_EFFECT

/// In the order of the table, and their descriptions.
[[nodiscard]] std::span<const PlotterEffect* const> plotter_effects();
[[nodiscard]] std::span<const effects::Effect* const> described_plotter_effects();

/// For `needs`.
[[nodiscard]] inline std::string_view needs_body(const PlotterMachine& machine) {
  return is_point(machine.gondola) ? "a gondola that two points hold" : "";
}
[[nodiscard]] inline std::string_view needs_pulley(const PlotterMachine& machine) {
  return machine.pulley_radius_mm > 0.0 ? "" : "a pulley or spool with its radius";
}

/// The visit at which an effect sets in.
inline constexpr EffectParameter kFirstVisit =
    effects::visit_parameter("first_visit", "number of the first visit at which it acts");

}  // namespace chaintrue::model::plotter
