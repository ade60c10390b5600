// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// belt_scale: a turn of a belt's encoder has another length than set.
///   s  true over counted, less 1
///   L  the belt, mm
///
///   added = L / (1 + s) - L                                                                 (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::belt_scale_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "scale",
    .symbol = "s",
    .meaning = "how much more belt a turn pays out, as a share",
    .nominal = 0.002,
    .lower = -0.05,
    .upper = 0.05,
    .prior_sigma = 0.002,
}};

// (1)
double add(const BeltState& belt, const BeltVisit& /*visit*/, Values values) {
  return belt.length_mm / (1.0 + values[0]) - belt.length_mm;
}

}  // namespace

extern constinit const BeltEffect belt_scale{
    .id = "belt_scale",
    .sides = kOneBeltOrAll,
    .parameters = kParameters,
    .cause = "one belt is worn, of another make, or runs on another pulley than the other three",
    .signature =
        "one belt reads short or long in proportion to its length; with all four, the frame and "
        "all cuts are of another size, and no reading shows it",
    .equation = "L / (1 + s)",
    .source = "an encoder turn is 43.975 mm of belt in the firmware, the same for all four",
    .not_modelled = "a scale that all four share: only a taped distance shows it",
    .typical = "0.1 to 0.3 %",
    .remedy = "look at that belt's pulley and teeth, change the belt",
    .add = add,
};

}  // namespace chaintrue::model::belts::belt_scale_effect
