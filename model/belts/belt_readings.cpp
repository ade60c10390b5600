// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_readings.hpp"

#include <algorithm>
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

bool by_tension(const std::vector<ResolvedBeltEffect>& effects) {
  return std::any_of(effects.begin(), effects.end(), [](const ResolvedBeltEffect& own) {
    return own.effect->by_tension;
  });
}

/// K of a belt.
double count_of(const std::vector<ResolvedBeltEffect>& effects,
                const BeltVisit& visit,
                const BeltState& belt) {
  double count_mm = belt.length_mm;
  for (const ResolvedBeltEffect& own : effects) {
    if (own.effect->add != nullptr && acts_on(own.side, visit.belt))
      count_mm += own.effect->add(belt, visit, own.values);
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
  BeltState state{belt->length_mm, machine.belt_turn_mm};
  if (by_tension(effects))
    state.tension = tensions_of(machine, visit.pulled, visit.pull, place)[visit.belt];
  return printed(machine, visit.belt, count_of(effects, visit, state));
}

tl::expected<BeltReadingSlopes, BeltFailure> read_belt_with_slope(
    const BeltMachine& machine,
    const std::vector<ResolvedBeltEffect>& effects,
    const BeltVisit& visit,
    FramePoint place) {
  const auto belt = belt_itself(machine, effects, visit, place);
  if (!belt) return tl::unexpected(belt.error());
  BeltState state{belt->length_mm, machine.belt_turn_mm};
  const bool loaded = by_tension(effects);
  const BeltTensions tensions = loaded
                                    ? tensions_at(machine, visit.pulled, visit.pull, place)
                                    : BeltTensions{};
  if (loaded) state.tension = tensions.tension[visit.belt];
  const double count_mm = count_of(effects, visit, state);
  const auto length = printed(machine, visit.belt, count_mm);
  if (!length) return tl::unexpected(length.error());
  double print_slope = 1.0;
  if (machine.lengths == BeltLengths::span) {
    const double c = height_mm(machine, visit.belt);
    print_slope = count_mm / std::sqrt((count_mm - c) * (count_mm + c));
  }
  const auto slope_by = [&](double BeltState::* quantity) {
    BeltState less = state, more = state;
    less.*quantity -= 0.5;
    more.*quantity += 0.5;
    return print_slope * (count_of(effects, visit, more) - count_of(effects, visit, less));
  };
  BeltReadingSlopes result;
  result.length_mm = *length;
  const double by_tension_mm = loaded ? slope_by(&BeltState::tension) : 0.0;
  for (const Belt anchor : kBelts) {
    Eigen::RowVector2d& own = result.by_anchor[anchor];
    own.setZero();
    if (loaded) own = by_tension_mm * tensions.by_anchor[visit.belt][anchor];
    if (anchor == visit.belt) own -= slope_by(&BeltState::length_mm) * belt->by_place;
    result.by_place -= own;
  }
  return result;
}

}  // namespace chaintrue::model::belts
