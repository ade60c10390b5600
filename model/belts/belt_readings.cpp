// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_readings.hpp"

#include <cmath>
#include <utility>

#include "model/effects/effect_table.hpp"

namespace chaintrue::model::belts {

std::vector<MachineProblem> problems_of(const std::vector<AppliedEffect>& applied) {
  return effects::problems_in(described_belt_effects(), applied);
}

std::vector<ResolvedBeltEffect> resolve_belt_effects(const std::vector<AppliedEffect>& applied) {
  std::vector<ResolvedBeltEffect> resolved;
  for (effects::TableEffect& own : effects::resolve(described_belt_effects(), applied))
    resolved.push_back({belt_effects()[own.number], own.side, std::move(own.values)});
  return resolved;
}

namespace {

/// L of a belt, with d(L)/d(place).
tl::expected<BeltReading, BeltFailure> belt_itself(const BeltMachine& machine,
                                                   const std::vector<ResolvedBeltEffect>& effects,
                                                   const BeltVisit& visit,
                                                   FramePoint place) {
  BeltMachine real = machine;
  // The horizontal span is the same for both printed forms of the real belt.
  real.lengths =
      machine.lengths == BeltLengths::belt_and_arm ? BeltLengths::belt_and_arm : BeltLengths::belt;
  for (const ResolvedBeltEffect& own : effects) {
    if (own.effect->alter != nullptr && acts_on(own.side, visit.belt))
      own.effect->alter(real.anchors[visit.belt], visit, own.values);
  }
  auto reading = reading_at(real, visit.belt, place);
  if (reading && real.lengths == BeltLengths::belt_and_arm) reading->length_mm -= reach_mm(machine);
  return reading;
}

/// K of a belt that is `length_mm` long.
double count_of(const BeltMachine& machine,
                const std::vector<ResolvedBeltEffect>& effects,
                const BeltVisit& visit,
                double length_mm) {
  double count_mm = length_mm;
  for (const ResolvedBeltEffect& own : effects) {
    if (own.effect->add != nullptr && acts_on(own.side, visit.belt))
      count_mm += own.effect->add(length_mm, machine.belt_turn_mm, visit, own.values);
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
                                            const std::vector<ResolvedBeltEffect>& effects,
                                            const BeltVisit& visit,
                                            FramePoint place) {
  const auto belt = belt_itself(machine, effects, visit, place);
  if (!belt) return tl::unexpected(belt.error());
  return printed(machine, visit.belt, count_of(machine, effects, visit, belt->length_mm));
}

tl::expected<BeltReading, BeltFailure> read_belt_with_slope(
    const BeltMachine& machine,
    const std::vector<ResolvedBeltEffect>& effects,
    const BeltVisit& visit,
    FramePoint place) {
  constexpr double kStepMm = 1.0;
  const auto belt = belt_itself(machine, effects, visit, place);
  if (!belt) return tl::unexpected(belt.error());
  const double count_mm = count_of(machine, effects, visit, belt->length_mm);
  const auto length = printed(machine, visit.belt, count_mm);
  if (!length) return tl::unexpected(length.error());
  double slope = (count_of(machine, effects, visit, belt->length_mm + kStepMm) -
                  count_of(machine, effects, visit, belt->length_mm - kStepMm)) /
                 (2.0 * kStepMm);
  if (machine.lengths == BeltLengths::span) {
    const double c = height_mm(machine, visit.belt);
    slope *= count_mm / std::sqrt((count_mm - c) * (count_mm + c));
  }
  return BeltReading{*length, slope * belt->by_place};
}

}  // namespace chaintrue::model::belts
