// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// ring_radius: the chain ends at another distance from the bit than stated.
///   rho  ring radius, stated and true [mm]
///   d    offset [mm]
///
///   rho = rho_stated + d                                                                    (1)
#include <variant>

#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::ring_radius_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "offset_mm",
    .symbol = "d",
    .meaning = "true ring radius less the file's",
    .nominal = 1.0,
    .lower = -50.0,
    .upper = 50.0,
    .prior_sigma = 1.0,
}};

// (1)
void alter(EquilibriumParameters& parameters, Values values) {
  if (auto* ring = std::get_if<Ring>(&parameters.attachment)) ring->radius_mm += values[0];
}

std::string_view needs_machine(const EquilibriumParameters& parameters) {
  return std::holds_alternative<Ring>(parameters.attachment)
             ? ""
             : "a sled on a ring (\"kind\": \"ring\")";
}

}  // namespace

extern constinit const Effect ring_radius{
    .id = "ring_radius",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause = "the ring or linkage is larger or smaller than the machine file says",
    .signature =
        "like both chain zeros off together; only the sag in the lower corners tells them apart",
    .equation = "rho = rho_stated + d",
    .source = "MaslowCNC forum reports 138.14 and 139.82 mm where 139.1 mm is set",
    .not_modelled = "a ring that is not round, carriages with play",
    .typical = "1 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "measure the ring from the bit to the chain's pin and enter that radius",
    .alter = alter,
    .needs_machine = needs_machine,
};

}  // namespace chaintrue::model::effects::ring_radius_effect
