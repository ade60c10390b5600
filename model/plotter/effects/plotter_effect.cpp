// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/effects/plotter_effect.hpp"

#include <vector>

namespace chaintrue::model::plotter {

std::span<const PlotterEffect* const> plotter_effects() {
#define CHAINTRUE_PLOTTER_EFFECT(id) &id,
  static constexpr const PlotterEffect* kEffects[] = {
#include "model/plotter/effects/plotter_effects.def"
  };
#undef CHAINTRUE_PLOTTER_EFFECT
  return kEffects;
}

std::span<const effects::Effect* const> described_plotter_effects() {
  static const std::vector<const effects::Effect*> all = [] {
    std::vector<const effects::Effect*> made;
    for (const PlotterEffect* effect : plotter_effects()) made.push_back(&effect->described);
    return made;
  }();
  return all;
}

}  // namespace chaintrue::model::plotter
