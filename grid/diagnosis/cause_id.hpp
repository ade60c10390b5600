// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What may be named: an effect of the catalogue at a side.
#pragma once

#include <compare>

namespace chaintrue::model::effects {
struct Effect;
enum class EffectSide;
}  // namespace chaintrue::model::effects

namespace chaintrue::grid::diagnosis {

/// An effect of the catalogue at a side.
struct CauseId {
  const model::effects::Effect* effect = nullptr;
  model::effects::EffectSide side{};  ///< EffectSide::none
  friend auto operator<=>(const CauseId&, const CauseId&) = default;
};

}  // namespace chaintrue::grid::diagnosis
