// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// anchor_height: an anchor is higher or lower than stated.
///   h  true less stated, mm
///
///   z += h                                                                                  (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::anchor_height_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "h",
    .meaning = "how far the anchor is above its setting",
    .nominal = 20.0,
    .lower = -300.0,
    .upper = 300.0,
    .prior_sigma = 20.0,
}};

// (1)
void alter(Anchor& anchor, const BeltVisit& /*visit*/, Values values) { anchor.z_mm += values[0]; }

}  // namespace

extern constinit const BeltEffect anchor_height{
    .id = "anchor_height",
    .sides = kOneBelt,
    .parameters = kParameters,
    .cause =
        "an anchor is not at the height that the settings say, or arms are mounted in another "
        "order",
    .signature = "one belt reads long where it is short",
    .equation = "z + h",
    .source = "kinematics: L^2 = B^2 + c^2",
    .not_modelled = "a sled that tilts on uneven heights",
    .typical = "10 to 40 mm",
    .remedy_kind = effects::RemedyKind::change_the_machine,
    .remedy = "measure the anchors' heights over the bed and enter them (tlZ, trZ, blZ, brZ)",
    .alter = alter,
};

}  // namespace chaintrue::model::belts::anchor_height_effect
