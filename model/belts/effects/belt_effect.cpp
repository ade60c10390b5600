// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/effects/belt_effect.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace chaintrue::model::belts {

bool acts_on(BeltSide side, Belt belt) {
  return side == BeltSide::none || side == BeltSide::all || name(side) == model::name(belt);
}

namespace {

/// In the order of the table.
const std::vector<effects::Effect>& descriptions() {
  static const std::vector<effects::Effect> all = [] {
    std::vector<effects::Effect> made;
    for (const BeltEffect* effect : belt_effects()) {
      made.push_back({
          .id = effect->id,
          .station =
              effect->alter != nullptr ? effects::Station::machine : effects::Station::chain,
          .sides = effect->sides,
          .parameters = effect->parameters,
          .cause = effect->cause,
          .signature = effect->signature,
          .equation = effect->equation,
          .source = effect->source,
          .not_modelled = effect->not_modelled,
          .typical = effect->typical,
          .needs = effect->needs,
          .remedy_kind = effect->remedy_kind,
          .remedy = effect->remedy,
      });
    }
    return made;
  }();
  return all;
}

}  // namespace

std::span<const BeltEffect* const> belt_effects() {
#define CHAINTRUE_BELT_EFFECT(id) &id,
  static constexpr const BeltEffect* kEffects[] = {
#include "model/belts/effects/belt_effects.def"
  };
#undef CHAINTRUE_BELT_EFFECT
  return kEffects;
}

const BeltEffect* find_belt_effect(std::string_view id) {
  for (const BeltEffect* effect : belt_effects()) {
    if (effect->id == id) return effect;
  }
  return nullptr;
}

const effects::Effect& described(const BeltEffect& effect) {
  const auto own = std::find(belt_effects().begin(), belt_effects().end(), &effect);
  if (own == belt_effects().end())
    throw std::invalid_argument("no effect of the table: " + std::string(effect.id));
  return descriptions()[static_cast<std::size_t>(own - belt_effects().begin())];
}

std::span<const effects::Effect* const> described_belt_effects() {
  static const std::vector<const effects::Effect*> all = [] {
    std::vector<const effects::Effect*> made;
    for (const effects::Effect& effect : descriptions()) made.push_back(&effect);
    return made;
  }();
  return all;
}

const BeltEffect* belt_effect_of(const effects::Effect& described) {
  for (std::size_t k = 0; k < descriptions().size(); ++k) {
    if (&descriptions()[k] == &described) return belt_effects()[k];
  }
  return nullptr;
}

}  // namespace chaintrue::model::belts
