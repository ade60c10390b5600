// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// side_pull: something pulls the sled sideways.
///   H_i  horizontal force of a chain [N]
///   f    force on the sled towards +x [N]
///
///   H_left - H_right = f                                                                    (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::side_pull_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "force_n",
    .symbol = "f",
    .meaning = "force on the sled towards +x",
    .nominal = 3.0,
    .lower = -10.0,
    .upper = 10.0,
    .prior_sigma = 3.0,
    .mirror_sign = -1.0,
}};

// (1)
void alter(EquilibriumParameters& parameters, Values values) {
  parameters.side_force_n += values[0];
}

}  // namespace

extern constinit const Effect side_pull{
    .id = "side_pull",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = kParameters,
    .cause = "a hose or a cord pulls the sled to one side",
    .signature =
        "one chain hangs slacker than its mirror image, most in the lower corner it pulls towards",
    .equation = "H_left - H_right = f",
    .source = "horizontal balance of the sled",
    .not_modelled = "a pull that changes with the sled's place, as a hose from a fixed hook does",
    .typical = "1 to 5 N, the weight of 100 to 500 g",
    .remedy_kind = RemedyKind::repair,
    .remedy = "hang the hose and the cord from a boom so that they pull straight up or not at all",
    .alter = alter,
};

}  // namespace chaintrue::model::effects::side_pull_effect
