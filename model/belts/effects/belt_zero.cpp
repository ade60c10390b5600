// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// belt_zero: the count of a belt, or of all four, starts from another length than set.
///   z  offset, mm
///
///   added = z                                                                               (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::belt_zero_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "z",
    .meaning = "what every reading is too long by",
    .nominal = 2.0,
    .lower = -500.0,
    .upper = 500.0,
    .prior_sigma = 3.0,
}};

// (1)
double add(const BeltState& /*belt*/, const BeltVisit& /*visit*/, Values values) {
  return values[0];
}

}  // namespace

extern constinit const BeltEffect belt_zero{
    .id = "belt_zero",
    .sides = kOneBeltOrAll,
    .parameters = kParameters,
    .cause =
        "a belt was not retracted to its end before it was counted; for all four, arm or extension "
        "are set wrong",
    .signature =
        "one belt is off by the same everywhere; all four: a frame too large or small, and four "
        "lengths that never quite meet",
    .equation = "+ z",
    .source = "kinematics: arm and extension are added to every belt",
    .not_modelled = "an arm that turns aside under load",
    .typical = "1 to 5 mm; 153.4 mm where lengths leave arm and extension out",
    .remedy =
        "retract all belts and extend them again; measure arm and extension and enter them; say "
        "with lengths what a length counts",
    .add = add,
};

}  // namespace chaintrue::model::belts::belt_zero_effect
