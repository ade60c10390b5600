// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// anchor_flex: an anchor, or the frame, yields along the pull of its belt, independent of the belt's
/// length.
///   g  how far at the pull that sizes refer to, mm
///   P  pull over that one
///
///   added = -g P of a belt that is pulled, 0 of one that holds                              (1)
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
  return visit.pulled ? -values[0] * visit.pull : 0.0;
}

}  // namespace

extern constinit const BeltEffect anchor_flex{
    .id = "anchor_flex",
    .sides = kNoBelt,
    .parameters = kParameters,
    .cause = "anchors, arms or the frame give when a belt is pulled",
    .signature = "the pulled belts read equally short wherever the tool is",
    .equation = "- g P of a pulled belt, P its pull over that of the first pass",
    .source = "a cantilever gives in proportion to its load; the motors pull to one current",
    .not_modelled = "anchors giving unequally, and across the pull",
    .typical = "0.5 to 2 mm",
    .remedy = "brace the frame and the anchors; pull with less current while the anchors are found",
    .add = add,
};

}  // namespace chaintrue::model::belts
