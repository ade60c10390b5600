// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What effects share: the sets of sides, and the parameter that says at which visit one acts.
#pragma once

#include <string_view>

#include "model/effects/effect.hpp"

namespace chaintrue::model::effects {

inline constexpr EffectSide kNoSide[] = {EffectSide::none};
inline constexpr EffectSide kOneChain[] = {EffectSide::left, EffectSide::right};
inline constexpr EffectSide kAnyChain[] = {EffectSide::left, EffectSide::right, EffectSide::both};
inline constexpr EffectSide kPaperAxes[] = {EffectSide::x, EffectSide::y, EffectSide::both};

/// The number of a visit; ten stands for any.
constexpr EffectParameter visit_parameter(std::string_view name, std::string_view meaning) {
  return {
      .name = name,
      .symbol = "m",
      .meaning = meaning,
      .role = ParameterRole::place,
      .null = 10.0,
      .nominal = 10.0,
      .lower = 0.0,
      .upper = 1e6,
      .prior_sigma = 10.0,
      .integer = true,
  };
}

}  // namespace chaintrue::model::effects
