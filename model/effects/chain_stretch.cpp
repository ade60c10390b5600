// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chain_stretch: the chain stretches more under tension than stated.
///   c  compliance, strain per newton of tension on unstretched length [1/N]
///   k  added compliance [1/N]
///
///   c = c_stated + k                                                                        (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::chain_stretch_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "compliance_per_n",
    .symbol = "k",
    .meaning = "compliance added to the machine's own",
    .nominal = 6e-6,
    .lower = 0.0,
    .upper = 1e-4,
    .prior_sigma = 6e-6,
}};

// (1)
void alter(EquilibriumParameters& parameters, Values values) {
  parameters.chain_compliance_per_n += values[0];
}

}  // namespace

extern constinit const Effect chain_stretch{
    .id = "chain_stretch",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause = "the chain gives more under tension than the machine file says",
    .signature = "the tool hangs low, most at the top centre, where both chains pull hardest",
    .equation = "c = c_stated + k; stretched length = S + integral of c T ds",
    .source =
        "MaslowCNC Firmware $45 5.1685e-6 /N; Tsubaki RS25: 2.6 mm/m at 640 N gives 4.1e-6 /N",
    .not_modelled = "creep, and a chain that stretches unevenly",
    .typical = "4e-6 to 8e-6 per N: 1 mm on 3 m at 60 N",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "put the compliance into the machine file",
    .alter = alter,
};

}  // namespace chaintrue::model::effects::chain_stretch_effect
