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
tl::expected<BeltReading, BeltFailure> belt_itself(const BeltMachine& machine,
                                                   const std::vector<effects::ActingEffect>& effects,
                                                   const BeltVisit& visit,
                                                   FramePoint place) {
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
  return std::any_of(effects.begin(), effects.end(), [](const effects::ActingEffect& own) {
    return own.effect->by_tension;
  });
}

/// K of a belt, with its derivatives by L and T.
effects::Number count_of(const BeltMachine& machine,
                         const std::vector<effects::ActingEffect>& effects,
                         const BeltVisit& visit,
                         double length_mm,
                         double tension) {
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
tl::expected<double, BeltFailure> printed(const BeltMachine& machine, Belt belt, double count_mm) {
  if (machine.lengths == BeltLengths::belt) return count_mm;
  if (machine.lengths == BeltLengths::belt_and_arm) return count_mm + reach_mm(machine);
  const double c = height_mm(machine, belt);
  if (!(count_mm > std::abs(c))) return tl::unexpected(BeltReason::shorter_than_height);
  return std::sqrt((count_mm - c) * (count_mm + c)) + reach_mm(machine);
}

}  // namespace

tl::expected<double, BeltFailure> read_belt(const BeltMachine& machine,
                                            const std::vector<effects::ActingEffect>& effects,
                                            const BeltVisit& visit,
                                            FramePoint place) {
  const auto belt = belt_itself(machine, effects, visit, place);
  if (!belt) return tl::unexpected(belt.error());
  const double tension =
      by_tension(effects) ? tensions_of(machine, visit.pulled, visit.pull, place)[visit.belt] : 0.0;
  return printed(machine,
                 visit.belt,
                 count_of(machine, effects, visit, belt->length_mm, tension).value);
}

tl::expected<BeltReadingSlopes, BeltFailure> read_belt_with_slope(
    const BeltMachine& machine,
    const std::vector<effects::ActingEffect>& effects,
    const BeltVisit& visit,
    FramePoint place) {
  const auto belt = belt_itself(machine, effects, visit, place);
  if (!belt) return tl::unexpected(belt.error());
  const bool loaded = by_tension(effects);
  const BeltTensions tensions = loaded
                                    ? tensions_at(machine, visit.pulled, visit.pull, place)
                                    : BeltTensions{};
  const effects::Number count = count_of(
      machine, effects, visit, belt->length_mm, loaded ? tensions.tension[visit.belt] : 0.0);
  const auto length = printed(machine, visit.belt, count.value);
  if (!length) return tl::unexpected(length.error());
  double print_slope = 1.0;
  if (machine.lengths == BeltLengths::span) {
    const double c = height_mm(machine, visit.belt);
    print_slope = count.value / std::sqrt((count.value - c) * (count.value + c));
  }
  BeltReadingSlopes result;
  result.length_mm = *length;
  for (const Belt anchor : kBelts) {
    Eigen::RowVector2d& own = result.by_anchor[anchor];
    own.setZero();
    if (loaded)
      own = print_slope * count.d[effects::kTension] * tensions.by_anchor[visit.belt][anchor];
    if (anchor == visit.belt) own -= print_slope * count.d[effects::kLength] * belt->by_place;
    result.by_place -= own;
  }
  return result;
}

}  // namespace chaintrue::model::belts
