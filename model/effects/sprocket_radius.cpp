// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sprocket_radius: the chain runs on another radius than stated.
///   r  radius of the chain line on the sprocket, for both the tangent and the wrap [mm]
///   d  offset [mm]
///
///   r = r_stated + d                                                                        (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::sprocket_radius_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "d",
    .meaning = "true radius of the chain line less the file's",
    .nominal = 0.17,
    .lower = -3.0,
    .upper = 3.0,
    .prior_sigma = 0.17,
}};

// (1)
void alter(EquilibriumParameters& parameters, Values values) {
  parameters.sprocket_radius_mm += values[0];
}

}  // namespace

extern constinit const Effect sprocket_radius{
    .id = "sprocket_radius",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause = "the chain lies on the sprockets at another radius than the machine file says",
    .signature = "a few tenths of a millimetre in the wrap; the chain zeros take nearly all of it",
    .equation = "r = r_stated + d, for tangent and wrap",
    .source =
        "10 teeth of 6.35 mm: 10.106 mm from the circumference, 10.274 mm as the pitch circle "
        "p / (2 sin(pi / z)); both are argued for",
    .not_modelled = "what one turn pays out: that is teeth times pitch, whatever the radius",
    .typical = "0.17 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "enter the radius in the machine file",
    .alter = alter,
};

}  // namespace chaintrue::model::effects::sprocket_radius_effect
