// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_readings.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::model::belts {

bool acts_on(effects::EffectSide side, Belt belt) {
  return side == effects::EffectSide::none || side == effects::EffectSide::all ||
         name(side) == model::name(belt);
}

namespace {

// 43.975 mm of belt with teeth 2 mm apart.
constexpr double kTeethInATurn = 22.0;

/// L of a belt, with d(L)/d(place).
tl::expected<BeltReading, BeltFailure> belt_itself(
    const BeltMachine& machine, const std::vector<effects::ActingEffect>& effects,
    const BeltVisit& visit, FramePoint place) {
  BeltMachine real = machine;
  // The horizontal span is the same for both printed forms of the real belt.
  real.lengths =
      machine.lengths == BeltLengths::belt_and_arm ? BeltLengths::belt_and_arm : BeltLengths::belt;
  for (const effects::ActingEffect& own : effects) {
    if (own.effect->alter_anchor != nullptr && acts_on(own.side, visit.belt))
      own.effect->alter_anchor(real.anchors[visit.belt], visit.order, own.values);
  }
  auto reading = reading_at(real, visit.belt, place);
  if (reading && real.lengths == BeltLengths::belt_and_arm) reading->length_mm -= reach_mm(machine);
  return reading;
}

bool by_tension(const std::vector<effects::ActingEffect>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const effects::ActingEffect& own) { return own.effect->by_tension; });
}

/// K of a belt, with its derivatives by L and T.
effects::Number count_of(const BeltMachine& machine,
                         const std::vector<effects::ActingEffect>& effects, const BeltVisit& visit,
                         double length_mm, double tension) {
  const effects::LengthState belt{.length_mm = effects::variable(length_mm, effects::kLength),
                                  .tension = effects::variable(tension, effects::kTension),
                                  .turn_mm = machine.belt_turn_mm,
                                  .tooth_mm = machine.belt_turn_mm / kTeethInATurn,
                                  .order = visit.order};
  effects::Number count_mm = belt.length_mm;
  for (const effects::ActingEffect& own : effects) {
    if (own.effect->add != nullptr && acts_on(own.side, visit.belt))
      count_mm = count_mm + own.effect->add(belt, own.values);
  }
  return count_mm;
}

/// print(K).
tl::expected<AnchorNumber, BeltFailure> printed(const BeltMachine& machine, Belt belt,
                                                const AnchorNumber& count_mm) {
  if (machine.lengths == BeltLengths::belt) return count_mm;
  if (machine.lengths == BeltLengths::belt_and_arm) return count_mm + reach_mm(machine);
  const double c = height_mm(machine, belt);
  if (!(count_mm.value > std::abs(c))) return tl::unexpected(BeltReason::shorter_than_height);
  return sqrt((count_mm - c) * (count_mm + c)) + reach_mm(machine);
}

}  // namespace

AnchorNumber of_anchor(const BeltReading& reading, Belt belt) {
  AnchorNumber length = reading.length_mm;
  for (const std::size_t axis : {0U, 1U})
    length.d[first_of(belt) + axis] = -reading.by_place[static_cast<Eigen::Index>(axis)];  // (1)
  return length;
}

tl::expected<AnchorNumber, BeltFailure> read_belt(const BeltMachine& machine,
                                                  const std::vector<effects::ActingEffect>& effects,
                                                  const BeltVisit& visit, FramePoint place) {
  const auto belt = belt_itself(machine, effects, visit, place);
  if (!belt) return tl::unexpected(belt.error());
  const AnchorNumber length = of_anchor(*belt, visit.belt);
  AnchorNumber tension;
  if (by_tension(effects))
    tension = tensions_of(machine, visit.pulled, visit.pull, place)[visit.belt];
  const effects::Number count = count_of(machine, effects, visit, length.value, tension.value);
  return printed(machine, visit.belt,
                 length.chained(count.value, count.d[effects::kLength]) +
                     tension.chained(0.0, count.d[effects::kTension]));
}

}  // namespace chaintrue::model::belts
