// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// direction_hysteresis: the reading differs between a chain that was paid out and one that was
/// taken in.
///   b  half of the width between the two [mm]
///   d  +1 paid out, -1 taken in
///
///   added = b d                                                                             (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::direction_hysteresis_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "half_width_mm",
    .symbol = "b",
    .meaning =
        "half of the difference between arriving with chain paid out and with chain taken in",
    .nominal = 0.35,
    .lower = 0.0,
    .upper = 5.0,
    .prior_sigma = 0.35,
}};

// (1)
double add_by_direction(double direction, Values values) { return direction * values[0]; }

}  // namespace

extern constinit const Effect direction_hysteresis{
    .id = "direction_hysteresis",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = kParameters,
    .cause = "friction, a ring that sticks and slips, or play in a gearbox",
    .signature = "the same place reads differently when it is reached from the other side",
    .equation = "+ b sign(change of that chain's length since the previous visit)",
    .source = "Coulomb friction and backlash, both of constant width",
    .not_modelled = "a width that grows with tension, and small moves inside the play",
    .typical = "0.2 to 0.5 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::compensate_on_its_own,
    .remedy =
        "grease the ring and take up the play, or compensate it along the path's direction; it is taken out "
        "of the readings that a map is made of",
    .add_by_direction = add_by_direction,
};

}  // namespace chaintrue::model::effects::direction_hysteresis_effect
