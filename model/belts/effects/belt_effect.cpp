// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts {

std::string_view name(BeltSide side) {
  switch (side) {
    case BeltSide::none:
      return "";
    case BeltSide::all:
      return "all";
    case BeltSide::tl:
      return "tl";
    case BeltSide::tr:
      return "tr";
    case BeltSide::bl:
      return "bl";
    case BeltSide::br:
      break;
  }
  return "br";
}

bool acts_on(BeltSide side, Belt belt) {
  return side == BeltSide::none || side == BeltSide::all || name(side) == model::name(belt);
}

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

}  // namespace chaintrue::model::belts
