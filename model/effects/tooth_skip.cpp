// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// tooth_skip: the chain jumps over teeth during the session.
///   p  nominal pitch [mm]
///   k  links
///   n  number of the visit
///   m  number of the first visit after the skip
///
///   added = p k for n >= m, otherwise 0                                                     (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::tooth_skip_effect {
namespace {

constexpr EffectParameter kParameters[] = {
    {
        .name = "links",
        .symbol = "k",
        .meaning = "whole links, positive where too many are read",
        .nominal = 1.0,
        .lower = -20.0,
        .upper = 20.0,
        .prior_sigma = 1.0,
        .integer = true,
    },
    visit_parameter("first_visit", "number of the first visit after the skip"),
};

// (1)
double misread(const VisitNote& visit, Values values) {
  return visit.order >= values[1] ? visit.pitch_mm * values[0] : 0.0;
}

}  // namespace

extern constinit const Effect tooth_skip{
    .id = "tooth_skip",
    .station = Station::reading,
    .sides = kOneChain,
    .parameters = kParameters,
    .cause = "the chain jumped over teeth of a sprocket during the measurement",
    .signature = "from one visit on, one chain is off by a whole number of links",
    .equation = "+ pitch k for n >= m",
    .source = "a roller chain that skips does so by whole teeth",
    .not_modelled = "a second skip back; give it as an effect of its own",
    .typical = "1 link, 6.35 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "look for a slack chain at the sprocket, set the chain to 12 o'clock again; the readings "
        "after the skip are corrected",
    .misread = misread,
};

}  // namespace chaintrue::model::effects::tooth_skip_effect
