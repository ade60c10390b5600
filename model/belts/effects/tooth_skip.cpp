// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// tooth_skip: a belt jumps over teeth of its pulley during the session.
///   k  teeth
///   p  the belt for a tooth: a turn has 22, mm
///   m  first visit after it
///
///   added = p k for n >= m                                                                  (1)
#include "model/belts/effects/belt_effect.hpp"

namespace chaintrue::model::belts::tooth_skip_effect {
namespace {

using effects::EffectParameter;

constexpr EffectParameter kParameters[] = {
    {
        .name = "teeth",
        .symbol = "k",
        .meaning = "whole teeth, positive where too much is read",
        .nominal = 1.0,
        .lower = -110.0,
        .upper = 110.0,
        .prior_sigma = 3.0,
        .integer = true,
    },
    kFirstVisit};

// 43.975 mm of belt with teeth 2 mm apart.
constexpr double kTeethInATurn = 22.0;

// (1)
double add(const BeltState& belt, const BeltVisit& visit, Values values) {
  return visit.order >= values[1] ? belt.turn_mm / kTeethInATurn * values[0] : 0.0;
}

}  // namespace

extern constinit const BeltEffect tooth_skip{
    .id = "tooth_skip",
    .sides = kOneBelt,
    .parameters = kParameters,
    .cause = "a belt jumped over teeth of its pulley, or its encoder lost turns",
    .signature = "from one visit on, one belt is off by a whole number of teeth",
    .equation = "+ k turn / 22 for n >= m",
    .source = "MaslowCNC/Maslow_4: 43.975 mm of belt for a turn of the encoder; teeth of 2 mm",
    .not_modelled = "a second skip back; give it as an effect of its own",
    .typical = "1 tooth, 2.0 mm; a turn, 44 mm",
    .needs = effects::DataNeed::order,
    .remedy =
        "look for a worn belt or a loose magnet of the encoder; retract and extend all belts and "
        "measure again",
    .add = add,
    .share = 0.3,
};

}  // namespace chaintrue::model::belts::tooth_skip_effect
