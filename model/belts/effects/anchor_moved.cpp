// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// anchor_moved: an anchor moves during the session and stays there.
///   d  how far, mm
///   a  which way, from x towards y, rad
///   m  first visit after it
///
///   anchor += d (cos a, sin a) for n >= m                                                   (1)
///
/// The same for all four: the frame moved as a whole, which does not change any length.
#include <cmath>

#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::anchor_moved_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {{
                                               .name = "distance_mm",
                                               .symbol = "d",
                                               .meaning = "how far the anchor moved",
                                               .nominal = 3.0,
                                               .lower = 0.0,
                                               .upper = 100.0,
                                               .prior_sigma = 3.0,
                                           },
                                           {
                                               .name = "direction_rad",
                                               .symbol = "a",
                                               .meaning = "which way, from x towards y",
                                               .role = effects::ParameterRole::place,
                                               .nominal = 0.0,
                                               .lower = -3.2,
                                               .upper = 3.2,
                                               .prior_sigma = 1.8,
                                           },
                                           kFirstVisit};

// (1)
void alter(Anchor& anchor, const BeltVisit& visit, Values values) {
  if (visit.order < values[2]) return;
  anchor.x_mm += values[0] * std::cos(values[1]);
  anchor.y_mm += values[0] * std::sin(values[1]);
}

}  // namespace

extern constinit const BeltEffect anchor_moved{
    .id = "anchor_moved",
    .sides = kOneBeltOrAll,
    .parameters = kParameters,
    .cause = "an anchor slipped or its screw came loose while the machine measured",
    .signature =
        "from one visit on, one belt disagrees with the other three, most where it points along "
        "the slip",
    .equation = "anchor + d (cos a, sin a) for n >= m",
    .source = "geometry",
    .not_modelled = "an anchor that creeps; use drift for it",
    .typical = "1 to 10 mm",
    .needs = effects::DataNeed::order,
    .remedy = "fasten that anchor and let the machine find its anchors again",
    .alter = alter,
    // An anchor that slips by just a tooth along its belt is rarer than a belt that skips, and as rare as a
    // belt that slips where it is clamped, which looks nearly the same.
    .share = 0.01,
};

}  // namespace chaintrue::model::belts::anchor_moved_effect
