// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/effect_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace chaintrue::model::effects {
namespace {

std::optional<EffectSide> side_of(const Effect& effect, std::string_view word) {
  for (const EffectSide side : effect.sides) {
    if (word == name(side)) return side;
  }
  return std::nullopt;
}

std::string joined_names(EffectTable table) {
  std::string ids;
  for (const Effect* known : table) ids += fmt::format("{}{}", ids.empty() ? "" : ", ", known->id);
  return ids;
}

std::string sides_in_words(const Effect& effect) {
  std::string words;
  for (const EffectSide side : effect.sides) {
    words +=
        fmt::format("{}{}", words.empty() ? "" : ", ", side == EffectSide::none ? "-" : name(side));
  }
  return words;
}

void check_values(const Effect& effect,
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
      for (const auto& parameter : effect.parameters)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", parameter.name);
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

const Effect* find_effect(EffectTable table, std::string_view id) {
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const Effect* own) { return own->id == id; });
  return found == table.end() ? nullptr : *found;
}

std::vector<MachineProblem> problems_in(EffectTable table,
                                        const std::vector<AppliedEffect>& applied) {
  std::vector<MachineProblem> problems;
  for (std::size_t i = 0; i < applied.size(); ++i) {
    const Effect* effect = find_effect(table, applied[i].effect);
    if (effect == nullptr) {
      problems.push_back(
          {fmt::format("/{}/effect", i), applied[i].effect, "one of " + joined_names(table)});
      continue;
    }
    if (!side_of(*effect, applied[i].side)) {
      problems.push_back({fmt::format("/{}/side", i),
                          applied[i].side.empty() ? "-" : applied[i].side,
                          fmt::format("a side of {}: {}", effect->id, sides_in_words(*effect))});
    }
    check_values(*effect, applied[i], fmt::format("/{}/parameters", i), problems);
  }
  return problems;
}

std::vector<TableEffect> resolve(EffectTable table, const std::vector<AppliedEffect>& applied) {
  if (const auto problems = problems_in(table, applied); !problems.empty()) {
    throw std::logic_error(fmt::format("{}: found {}, expected {}",
                                       problems.front().parameter,
                                       problems.front().value,
                                       problems.front().expected));
  }
  std::vector<TableEffect> resolved;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const Effect& effect = *table[k];
    for (const AppliedEffect& one : applied) {
      if (one.effect != effect.id) continue;
      TableEffect own{k, *side_of(effect, one.side), {}};
      for (const EffectParameter& parameter : effect.parameters) {
        const auto given = one.parameters.find(std::string(parameter.name));
        own.values.push_back(given == one.parameters.end() ? parameter.nominal : given->second);
      }
      resolved.push_back(std::move(own));
    }
  }
  return resolved;
}

}  // namespace chaintrue::model::effects
