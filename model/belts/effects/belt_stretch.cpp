// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// belt_stretch: a belt that is pulled tight is longer than its encoder counts.
///   e  elongation at the pull that sizes refer to, T / EA
///   P  pull over that one
///   L  the belt, mm
///
///   added = -e P L of a belt that is pulled, 0 of one that holds                            (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "elongation",
    .symbol = "e",
    .meaning = "extra stretch of a pulled belt over one that holds",
    .nominal = 0.004,
    .lower = 0.0,
    .upper = 0.03,
    .prior_sigma = 0.003,
}};

// (1)
double add(double length_mm, double /*turn_mm*/, const BeltVisit& visit, Values values) {
  return visit.pulled ? -values[0] * visit.pull * length_mm : 0.0;
}

}  // namespace

extern constinit const BeltEffect belt_stretch{
    .id = "belt_stretch",
    .sides = kNoBelt,
    .parameters = kParameters,
    .cause = "belts, anchors or arms give with the pull, in proportion to the belt's length",
    .signature =
        "pulled belts read short against those that hold, the long ones more; with the upper belts "
        "held, the frame comes out some millimetres too small at the bottom",
    .equation = "- e P L of a pulled belt, P its pull over that of the first pass",
    .source =
        "four owners' sets: 0.30 to 0.55 %; a tension test: 0.18 to 0.31 %; MaslowCNC/Maslow_4 "
        "pull 1060: EA = 178,900 N",
    .not_modelled =
        "the stretch of the belts that hold, under the sled's weight and the other two's pull",
    .typical = "0.3 to 0.5 %",
    .remedy_kind = effects::RemedyKind::change_the_machine,
    .remedy =
        "pull with less current while the anchors are found "
        "(Maslow_Calibration_Current_Threshold), or fit the stretch together with the anchors",
    .add = add,
};

}  // namespace chaintrue::model::belts
