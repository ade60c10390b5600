// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// beam_flex: the top beam yields where the motors pull on it.
///   a_i  motor axis [mm]
///   T_i  tension at the sprocket [N]
///   t_i  unit vector along the chain there, towards the sled
///   k    flexibility [mm/N]
///
///   a_i = a_i,stated + k T_i t_i                                                            (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::beam_flex_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "flexibility_mm_per_n",
    .symbol = "k",
    .meaning = "how far a motor's axis moves along its chain's pull, per newton",
    .nominal = 0.01,
    .lower = 0.0,
    .upper = 0.1,
    .prior_sigma = 0.01,
}};

// (1), solved together with the equilibrium
void alter(EquilibriumParameters& parameters, Values values) {
  parameters.beam_flexibility_mm_per_n += values[0];
}

}  // namespace

extern constinit const Effect beam_flex{
    .id = "beam_flex",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause = "the top beam or its brackets give under the pull of the chains",
    .signature =
        "the tool hangs low and the bed shrinks towards the top centre, where tension is highest",
    .equation = "motor axis = as set + k T_i (unit vector along the chain, towards the sled)",
    .source = "MaslowCNC GroundControl PR 558: motor spacing 2990 mm free, 2980 mm under load",
    .not_modelled =
        "a beam that gives differently along its length, in its plane and across; the other "
        "chain's pull on this motor",
    .typical = "0.003 to 0.02 mm/N: 0.5 to 3 mm at the bed's top",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "brace the beam, or put its flexibility into the machine file",
    .alter = alter,
};

}  // namespace chaintrue::model::effects::beam_flex_effect
