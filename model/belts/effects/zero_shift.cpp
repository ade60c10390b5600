// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// zero_shift: the zero of a belt moves once, by any amount.
///   z  shift, mm
///   m  first visit after it
///
///   added = z for n >= m                                                                    (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::zero_shift_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {
    {
        .name = "shift_mm",
        .symbol = "z",
        .meaning = "how much too long each later reading is",
        .nominal = 2.0,
        .lower = -500.0,
        .upper = 500.0,
        // As a belt's own zero: a belt that is retracted anew, or slips in its clamp, does so by millimetres.
        .prior_sigma = 3.0,
    },
    kFirstVisit};

// (1)
double add(const BeltState& /*belt*/, const BeltVisit& visit, Values values) {
  return visit.order >= values[1] ? values[0] : 0.0;
}

}  // namespace

extern constinit const BeltEffect zero_shift{
    .id = "zero_shift",
    .sides = kOneBelt,
    .parameters = kParameters,
    .cause = "the zero of a belt moved while the machine measured",
    .signature =
        "from one visit on, one belt is off by the same amount, which need not be whole teeth",
    .equation = "+ z for n >= m",
    .source = "a belt that was retracted and extended anew, or slips where it is clamped",
    .not_modelled = "a second shift; give it as an effect of its own",
    .typical = "1 to 10 mm",
    .needs = effects::DataNeed::order,
    .remedy =
        "look where the belt is clamped and at its retraction; retract and extend all belts and "
        "measure again",
    .add = add,
    // What sets in during a session is rare, and a skip is the usual form of it.
    .share = 0.01,
};

}  // namespace chaintrue::model::belts::zero_shift_effect
