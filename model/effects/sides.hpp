// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sets of sides that effects share.
#pragma once

#include "model/effects/effect.hpp"

namespace chaintrue::model::effects {

inline constexpr EffectSide kNoSide[] = {EffectSide::none};
inline constexpr EffectSide kOneChain[] = {EffectSide::left, EffectSide::right};
inline constexpr EffectSide kAnyChain[] = {EffectSide::left, EffectSide::right, EffectSide::both};
inline constexpr EffectSide kPaperAxes[] = {EffectSide::x, EffectSide::y, EffectSide::both};

}  // namespace chaintrue::model::effects
