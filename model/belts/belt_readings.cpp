// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace chaintrue::model::belts {
namespace {

std::optional<BeltSide> side_of(const BeltEffect& effect, std::string_view word) {
  for (const BeltSide side : effect.sides) {
    if (word == name(side)) return side;
  }
  return std::nullopt;
}

std::string sides_in_words(const BeltEffect& effect) {
  std::string words;
  for (const BeltSide side : effect.sides) {
    words +=
        fmt::format("{}{}", words.empty() ? "" : ", ", side == BeltSide::none ? "-" : name(side));
  }
  return words;
}

void check_parameters(const BeltEffect& effect,
                      const AppliedEffect& applied,
                      const std::string& place,
                      std::vector<MachineProblem>& problems) {
  for (const auto& [key, value] : applied.parameters) {
    const auto known = std::find_if(
        effect.parameters.begin(), effect.parameters.end(), [&wanted = key](const auto& parameter) {
          return parameter.name == wanted;
        });
    if (known == effect.parameters.end()) {
      std::string names;
      for (const auto& parameter : effect.parameters) {
        names += fmt::format("{}{}", names.empty() ? "" : ", ", parameter.name);
      }
      problems.push_back({place, key, fmt::format("a parameter of {}: {}", effect.id, names)});
    } else if (!(value >= known->lower && value <= known->upper) ||
               (known->integer && value != std::floor(value))) {
      problems.push_back({place,
                          fmt::format("{}={}", key, value),
                          fmt::format("a {}number from {} to {}",
                                      known->integer ? "whole " : "",
                                      known->lower,
                                      known->upper)});
    }
  }
}

}  // namespace

std::vector<MachineProblem> problems_of(const std::vector<AppliedEffect>& applied) {
  std::vector<MachineProblem> problems;
  for (std::size_t i = 0; i < applied.size(); ++i) {
    const BeltEffect* effect = find_belt_effect(applied[i].effect);
    if (effect == nullptr) {
      std::string ids;
      for (const BeltEffect* known : belt_effects()) {
        ids += fmt::format("{}{}", ids.empty() ? "" : ", ", known->id);
      }
      problems.push_back({fmt::format("/{}/effect", i), applied[i].effect, "one of " + ids});
      continue;
    }
    if (!side_of(*effect, applied[i].side)) {
      problems.push_back({fmt::format("/{}/side", i),
                          applied[i].side.empty() ? "-" : applied[i].side,
                          fmt::format("a side of {}: {}", effect->id, sides_in_words(*effect))});
    }
    check_parameters(*effect, applied[i], fmt::format("/{}/parameters", i), problems);
  }
  return problems;
}

std::vector<ResolvedBeltEffect> resolve_belt_effects(const std::vector<AppliedEffect>& applied) {
  if (const auto problems = problems_of(applied); !problems.empty()) {
    throw std::logic_error(fmt::format("{}: found {}, expected {}",
                                       problems.front().parameter,
                                       problems.front().value,
                                       problems.front().expected));
  }
  std::vector<ResolvedBeltEffect> resolved;
  for (const BeltEffect* effect : belt_effects()) {
    for (const AppliedEffect& one : applied) {
      if (one.effect != effect->id) continue;
      ResolvedBeltEffect own{effect, *side_of(*effect, one.side), {}};
      for (const effects::EffectParameter& parameter : effect->parameters) {
        const auto given = one.parameters.find(std::string(parameter.name));
        own.values.push_back(given == one.parameters.end() ? parameter.nominal : given->second);
      }
      resolved.push_back(std::move(own));
    }
  }
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
  if (!(count_mm > std::abs(c))) return tl::unexpected(BeltFailure::shorter_than_height);
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
