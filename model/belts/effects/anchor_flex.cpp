// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// anchor_flex: an anchor, or the frame, yields along its belt in proportion to the belt's tension,
/// independent of the belt's length.
///   g  how far at the pull that sizes refer to, mm
///   T  the belt's tension over that pull (belt_statics.hpp); belts that hold carry the reaction of
///      those that are pulled
///
///   added = -g T                                                                            (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::anchor_flex_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
    .name = "give_mm",
    .symbol = "g",
    .meaning = "how far an anchor moves towards the tool at the pull of the motors",
    .nominal = 1.0,
    .lower = 0.0,
    .upper = 20.0,
    .prior_sigma = 1.0,
}};

// (1)
double add(const BeltState& belt, const BeltVisit& /*visit*/, Values values) {
  return -values[0] * belt.tension;
}

}  // namespace

extern constinit const BeltEffect anchor_flex{
    .id = "anchor_flex",
    .sides = kNoBelt,
    .parameters = kParameters,
    .cause = "anchors, arms or the frame give when belts are pulled",
    .signature = "belts read short by what they carry, however long they are",
    .equation = "- g T, T the belt's tension over the pull of the first pass: 1 of a pulled belt, of one that holds what the balance takes",
    .source = "a cantilever gives in proportion to its load; the motors pull to one current",
    .not_modelled = "anchors giving unequally, and across the pull; the sled's friction on the sheet",
    .typical = "0.5 to 2 mm",
    .remedy = "brace the frame and the anchors; pull with less current while the anchors are found",
    .add = add,
    .by_tension = true,
    .expected = 0.2,  // belt_stretch.cpp
};

}  // namespace chaintrue::model::belts::anchor_flex_effect
