// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What may be named: an effect of the catalogue at a side.
#pragma once

#include "model/effects/effect.hpp"

namespace chaintrue::grid::diagnosis {

/// An effect of the catalogue at a side.
struct CauseId {
  const model::effects::Effect* effect = nullptr;
  model::effects::EffectSide side = model::effects::EffectSide::none;
  friend bool operator==(const CauseId&, const CauseId&) = default;
};

}  // namespace chaintrue::grid::diagnosis
