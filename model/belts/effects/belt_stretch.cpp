// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// belt_stretch: a belt under tension is longer than its encoder counts.
///   e  elongation at the pull that sizes refer to: that force over EA
///   T  the belt's tension over that pull (belt_statics.hpp); belts that hold carry the reaction of
///      those that are pulled
///   L  the belt, mm
///
///   added = -e T L                                                                          (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::belt_stretch_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "elongation",
    .symbol = "e",
    .meaning = "stretch of a belt at the pull of the motors",
    .nominal = 0.002,
    .lower = 0.0,
    .upper = 0.03,
    .prior_sigma = 0.002,
}};

// (1)
double add(const BeltState& belt, const BeltVisit& /*visit*/, Values values) {
  return -values[0] * belt.tension * belt.length_mm;
}

}  // namespace

extern constinit const BeltEffect belt_stretch{
    .id = "belt_stretch",
    .sides = kNoBelt,
    .parameters = kParameters,
    .cause = "belts, anchors or arms give with the pull, in proportion to the belt's length",
    .signature =
        "belts read short by what they carry, the long ones more; with the upper belts held, the "
        "frame comes out some millimetres too small at the bottom",
    .equation = "- e T L, T the belt's tension over the pull of the first pass: 1 of a pulled belt, of one that holds what the balance takes",
    .source =
        "four owners' sets: 0.13 to 0.26 %; a tension test: 0.1 to 0.15 % between two pulls; "
        "MaslowCNC/Maslow_4 pull 1060: EA = 178,900 N",
    .not_modelled =
        "the sled's friction on the sheet; a weight other than 0.3 of the pull",
    .typical = "0.1 to 0.3 %",
    .remedy_kind = effects::RemedyKind::change_the_machine,
    .remedy =
        "pull with less current while the anchors are found "
        "(Maslow_Calibration_Current_Threshold), or fit the stretch together with the anchors",
    .add = add,
    .by_tension = true,
    // All four published frames give with the pull. Three tell the belts' stretch from anchors that give, by
    // factors of 1000 and more; the fourth does not tell.
    .expected = 0.8,
};

}  // namespace chaintrue::model::belts::belt_stretch_effect
