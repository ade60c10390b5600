// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// drift: a belt's count drifts from visit to visit.
///   d  rate, mm per visit
///
///   added = d n                                                                             (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::drift_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "rate_mm_per_visit",
    .symbol = "d",
    .meaning = "what a reading gains with each visit",
    .nominal = 0.03,
    .lower = -1.0,
    .upper = 1.0,
    .prior_sigma = 0.03,
}};

// (1)
double add(const BeltState& /*belt*/, const BeltVisit& visit, Values values) {
  return values[0] * visit.order;
}

}  // namespace

extern constinit const BeltEffect drift{
    .id = "drift",
    .sides = kOneBeltOrAll,
    .parameters = kParameters,
    .cause = "a belt, an anchor or the frame crept while the machine measured",
    .signature = "the last places disagree with the first ones",
    .equation = "+ d n",
    .source = "four belts pull at a frame for as long as it is measured",
    .not_modelled = "a drift that levels off, and pauses between visits",
    .typical = "0.01 to 0.05 mm a visit",
    .needs = effects::DataNeed::order,
    .remedy = "let the frame stand under tension before measuring, and measure again",
    .add = add,
};

}  // namespace chaintrue::model::belts::drift_effect
