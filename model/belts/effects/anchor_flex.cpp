// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// anchor_flex: an anchor, or the frame, yields along the pull of its belt, independent of the belt's
/// length.
///   g  how far, mm
///
///   added = -g of a belt that is pulled, 0 of one that holds                                (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "give_mm",
    .symbol = "g",
    .meaning = "how far an anchor moves towards the tool when its belt is pulled",
    .nominal = 1.0,
    .lower = 0.0,
    .upper = 20.0,
    .prior_sigma = 1.0,
}};

// (1)
double add(double /*length_mm*/, double /*turn_mm*/, const BeltVisit& visit, Values values) {
  return visit.pulled ? -values[0] : 0.0;
}

}  // namespace

extern constinit const BeltEffect anchor_flex{
    .id = "anchor_flex",
    .sides = kNoBelt,
    .parameters = kParameters,
    .cause = "anchors, arms or the frame give when a belt is pulled",
    .signature = "the pulled belts read short by as much wherever the tool is",
    .equation = "- g of a pulled belt",
    .source = "a cantilever gives in proportion to its load; the motors pull to one current",
    .not_modelled = "anchors that give unlike, and across the pull",
    .typical = "0.5 to 2 mm",
    .remedy = "brace the frame and the anchors; pull with less current while the anchors are found",
    .add = add,
};

}  // namespace chaintrue::model::belts
