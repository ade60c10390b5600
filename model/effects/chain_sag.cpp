// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chain_sag: the chain is heavier or lighter than stated, so it hangs deeper or less deep.
///   w  chain weight in the sheet's plane [N/mm]
///   q  relative excess
///
///   w = w_stated (1 + q)                                                                    (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::chain_sag_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "relative_weight",
    .symbol = "q",
    .meaning = "true chain mass over the file's, less one",
    .nominal = 0.3,
    .lower = -0.95,
    .upper = 5.0,
    .prior_sigma = 0.3,
}};

// (1)
void alter(EquilibriumParameters& parameters, Values values) {
  parameters.chain_weight_n_per_mm *= 1.0 + values[0];
}

}  // namespace

extern constinit const Effect chain_sag{
    .id = "chain_sag",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause =
        "the chain's mass per metre is not what the machine file says, so it sags more or less",
    .signature =
        "up to millimetres in the lower corners, where one chain is long and slack; little "
        "elsewhere",
    .equation = "w = w_stated (1 + q) in the elastic catenary",
    .source =
        "statics of the two chains, docs/physics; chain masses from 0.125 to 0.141 kg/m are met",
    .not_modelled = "dirt or oil that gathers on part of a chain",
    .typical = "30 %",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "weigh a metre of chain and enter its mass",
    .alter = alter,
};

}  // namespace chaintrue::model::effects::chain_sag_effect
