// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chain_pitch_error: the links are longer than nominal, so fewer of them are counted.
///   L  true length paid out, with all effects at the chain [mm]
///   e  elongation
///
///   L_counted = L / (1 + e)                                                                 (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::chain_pitch_error_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "elongation",
    .symbol = "e",
    .meaning = "true length of a link over the nominal pitch, less one",
    .nominal = 0.001,
    .lower = -0.05,
    .upper = 0.05,
    .prior_sigma = 0.001,
}};

// e of (1); the reading model divides once, by the sum of all
double elongation(Values values) { return values[0]; }

}  // namespace

extern constinit const Effect chain_pitch_error{
    .id = "chain_pitch_error",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = kParameters,
    .cause = "the chain's links are worn or were never of the right length",
    .signature = "an error in proportion to the length of one chain, or of both",
    .equation = "L / (1 + e)",
    .source =
        "MaslowCNC GroundControl, left and right chain tolerance; worn roller chain is changed at "
        "2 to 3 %",
    .not_modelled = "wear of the part that runs over the sprocket most",
    .typical = "0.05 to 0.15 %: 1.5 to 4.5 mm on 3 m",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy =
        "measure 100 links under load and put the elongation into the machine file, or change the "
        "chain",
    .elongation = elongation,
};

}  // namespace chaintrue::model::effects::chain_pitch_error_effect
