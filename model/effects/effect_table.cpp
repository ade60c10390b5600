// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/effect_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace chaintrue::model::effects {
namespace {

std::string quoted_list(const std::vector<std::string_view>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " or " : ", ";
    list += fmt::format("\"{}\"", names[i]);
  }
  return list;
}

std::string expected_sides(const Effect& effect) {
  if (effect.sides.front() == EffectSide::none) return "no side (null): it has none";
  std::vector<std::string_view> names;
  for (const EffectSide side : effect.sides) names.push_back(name(side));
  return quoted_list(names);
}

std::string expected_value(const EffectParameter& parameter) {
  return fmt::format("{} from {} to {}", parameter.integer ? "a whole number" : "a number",
                     parameter.lower, parameter.upper);
}

const EffectSide* find_side(const Effect& effect, std::string_view side) {
  const auto found = std::find_if(effect.sides.begin(), effect.sides.end(),
                                  [&](EffectSide s) { return name(s) == side; });
  return found == effect.sides.end() ? nullptr : &*found;
}

bool acceptable(const EffectParameter& parameter, double value) {
  return value >= parameter.lower && value <= parameter.upper &&
         (!parameter.integer || value == std::floor(value));
}

void check_parameters(const Effect& effect, const AppliedEffect& applied, const std::string& place,
                      bool all_stated, std::vector<MachineProblem>& problems) {
  std::vector<std::string_view> names;
  for (const EffectParameter& parameter : effect.parameters) {
    names.push_back(parameter.name);
    const std::string at = fmt::format("{}/parameters/{}", place, parameter.name);
    const auto found = applied.parameters.find(std::string(parameter.name));
    if (found == applied.parameters.end()) {
      if (all_stated)
        problems.push_back(
            {at, "", fmt::format("{}: {}", expected_value(parameter), parameter.meaning)});
    } else if (!acceptable(parameter, found->second)) {
      problems.push_back({at, fmt::format("{}", found->second), expected_value(parameter)});
    }
  }
  for (const auto& [key, value] : applied.parameters) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    problems.push_back({fmt::format("{}/parameters/{}", place, key), fmt::format("{}", value),
                        fmt::format("{} takes {}", effect.id, quoted_list(names))});
  }
}

}  // namespace

const Effect* find_effect(EffectTable table, std::string_view id) {
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const Effect* own) { return own->id == id; });
  return found == table.end() ? nullptr : *found;
}

std::vector<MachineProblem> problems_in(EffectTable table,
                                        const std::vector<AppliedEffect>& applied,
                                        bool all_stated) {
  std::vector<MachineProblem> problems;
  for (std::size_t i = 0; i < applied.size(); ++i) {
    const std::string place = fmt::format("/{}", i);
    const Effect* effect = find_effect(table, applied[i].effect);
    if (effect == nullptr) {
      std::vector<std::string_view> ids;
      for (const Effect* known : table) ids.push_back(known->id);
      problems.push_back({place + "/effect", applied[i].effect,
                          "an effect of the catalogue: " + quoted_list(ids)});
      continue;
    }
    if (find_side(*effect, applied[i].side) == nullptr) {
      problems.push_back({place + "/side", applied[i].side.empty() ? "null" : applied[i].side,
                          expected_sides(*effect)});
    }
    check_parameters(*effect, applied[i], place, all_stated, problems);
  }
  return problems;
}

std::vector<ActingEffect> resolve(EffectTable table, const std::vector<AppliedEffect>& applied) {
  require_none(problems_in(table, applied));
  std::vector<ActingEffect> resolved;
  for (const Effect* effect : table) {
    for (const AppliedEffect& one : applied) {
      if (one.effect != effect->id) continue;
      ActingEffect own{effect, *find_side(*effect, one.side), {}};
      for (const EffectParameter& parameter : effect->parameters) {
        const auto given = one.parameters.find(std::string(parameter.name));
        own.values.push_back(given == one.parameters.end() ? parameter.nominal : given->second);
      }
      resolved.push_back(std::move(own));
    }
  }
  return resolved;
}

}  // namespace chaintrue::model::effects
