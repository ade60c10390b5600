// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/effects/declared_effect.hpp"

namespace chaintrue::model::effects {

// Each effect's file has a namespace of its own, so that files compiled together may use the same names.
#define CHAINTRUE_EFFECT(id)  \
  namespace id##_effect {     \
  extern const Effect id;     \
  }                           \
  using id##_effect::id;
#include "model/effects/effects.def"
#undef CHAINTRUE_EFFECT

namespace {

constexpr const Effect* kCatalogue[] = {
#define CHAINTRUE_EFFECT(id) &id,
#include "model/effects/effects.def"
#undef CHAINTRUE_EFFECT
};

std::string quoted_list(std::span<const std::string_view> names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " or " : ", ";
    list += fmt::format("\"{}\"", names[i]);
  }
  return list;
}

std::string known_ids(const Machine& machine) {
  std::vector<std::string_view> ids;
  for (const Effect* effect : effects_of(machine)) ids.push_back(effect->id);
  return quoted_list(ids);
}

std::string expected_sides(const Effect& effect) {
  if (effect.sides.front() == EffectSide::none) return "no side (null): it has none";
  std::vector<std::string_view> names;
  for (const EffectSide side : effect.sides) names.push_back(name(side));
  return quoted_list(names);
}

std::string expected_value(const EffectParameter& parameter) {
  return fmt::format("{} from {} to {}",
                     parameter.integer ? "a whole number" : "a number",
                     parameter.lower,
                     parameter.upper);
}

/// Where it acts among the others: in the catalogue's order, those that are declared at the end, by
/// their names.
std::size_t order_of(const Effect& effect) {
  const Declaration* declaration = declaration_of(effect);
  if (declaration == nullptr) return place_in_catalogue(effect);
  const Effect* stood = find_effect(declaration->instead_of);
  return stood != nullptr ? place_in_catalogue(*stood) : std::size(kCatalogue);
}

const EffectSide* find_side(const Effect& effect, std::string_view side) {
  const auto found = std::find_if(
      effect.sides.begin(), effect.sides.end(), [&](EffectSide s) { return name(s) == side; });
  return found == effect.sides.end() ? nullptr : &*found;
}

bool acceptable(const EffectParameter& parameter, double value) {
  return value >= parameter.lower && value <= parameter.upper &&
         (!parameter.integer || value == std::floor(value));
}

void check_parameters(const Effect& effect,
                      const AppliedEffect& applied,
                      const std::string& place,
                      std::vector<MachineProblem>& problems) {
  std::vector<std::string_view> names;
  for (const EffectParameter& parameter : effect.parameters) {
    names.push_back(parameter.name);
    const std::string at = fmt::format("{}/parameters/{}", place, parameter.name);
    const auto found = applied.parameters.find(std::string(parameter.name));
    if (found == applied.parameters.end()) {
      problems.push_back(
          {at, "", fmt::format("{}: {}", expected_value(parameter), parameter.meaning)});
    } else if (!acceptable(parameter, found->second)) {
      problems.push_back({at, fmt::format("{}", found->second), expected_value(parameter)});
    }
  }
  for (const auto& [key, value] : applied.parameters) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    problems.push_back({fmt::format("{}/parameters/{}", place, key),
                        fmt::format("{}", value),
                        fmt::format("{} takes {}", effect.id, quoted_list(names))});
  }
}

// Ranges of the sums of the machine's own numbers and its effects.
void check_sums(const Machine& machine, std::vector<MachineProblem>& problems) {
  EquilibriumParameters parameters = equilibrium_parameters(machine);
  for (std::size_t i = 0; i < machine.effects.size(); ++i) {
    const AppliedEffect& named = machine.effects[i];
    const Effect& effect = *find_effect(machine, named.effect);
    if (effect.alter == nullptr) continue;
    const std::string place = fmt::format("/effects/{}", i);
    if (effect.needs_machine != nullptr) {
      const std::string_view needed = effect.needs_machine(parameters);
      if (!needed.empty()) {
        problems.push_back({place + "/effect", named.effect, fmt::format("{} to act on", needed)});
        continue;
      }
    }
    std::vector<double> values;
    for (const EffectParameter& parameter : effect.parameters) {
      values.push_back(named.parameters.at(std::string(parameter.name)));
    }
    effect.alter(parameters, values);
    const auto* ring = std::get_if<Ring>(&parameters.attachment);
    const bool sound =
        parameters.sprocket_radius_mm > 0.0 && parameters.chain_weight_n_per_mm > 0.0 &&
        parameters.chain_compliance_per_n >= 0.0 && (ring == nullptr || ring->radius_mm >= 0.0);
    if (!sound) {
      problems.push_back(
          {place,
           named.effect,
           "together with the machine's own values: sprocket radius and chain mass above 0, ring "
           "radius and compliance not below 0"});
      return;
    }
  }
}

}  // namespace

std::span<const Effect* const> catalogue() { return kCatalogue; }

const Effect* find_effect(std::string_view id) {
  const auto found = std::find_if(std::begin(kCatalogue),
                                  std::end(kCatalogue),
                                  [&](const Effect* effect) { return effect->id == id; });
  return found == std::end(kCatalogue) ? nullptr : *found;
}

std::vector<const Effect*> effects_of(const Machine& machine) {
  std::vector<const Effect*> all(std::begin(kCatalogue), std::end(kCatalogue));
  for (const Effect* own : machine.declared) {
    const std::string& instead_of = declaration_of(*own)->instead_of;
    const auto stood = std::find_if(
        all.begin(), all.end(), [&](const Effect* effect) { return effect->id == instead_of; });
    if (stood == all.end()) {
      all.push_back(own);
    } else {
      *stood = own;
    }
  }
  return all;
}

const Effect* find_effect(const Machine& machine, std::string_view id) {
  for (const Effect* own : machine.declared) {
    if (own->id == id) return own;
  }
  return find_effect(id);
}

std::size_t place_in_catalogue(const Effect& effect) {
  const auto found = std::find(std::begin(kCatalogue), std::end(kCatalogue), &effect);
  if (found == std::end(kCatalogue)) {
    throw std::invalid_argument(fmt::format("effect {} is not in effects.def", effect.id));
  }
  return static_cast<std::size_t>(found - std::begin(kCatalogue));
}

std::vector<MachineProblem> problems_of_effects(const Machine& machine) {
  std::vector<MachineProblem> problems;
  for (std::size_t i = 0; i < machine.effects.size(); ++i) {
    const AppliedEffect& applied = machine.effects[i];
    const std::string place = fmt::format("/effects/{}", i);
    const Effect* effect = find_effect(machine, applied.effect);
    if (effect == nullptr) {
      problems.push_back(
          {place + "/effect", applied.effect, "an effect of the catalogue: " + known_ids(machine)});
      continue;
    }
    if (find_side(*effect, applied.side) == nullptr) {
      problems.push_back(
          {place + "/side", applied.side.empty() ? "null" : applied.side, expected_sides(*effect)});
    }
    check_parameters(*effect, applied, place, problems);
  }
  if (problems.empty()) check_sums(machine, problems);
  return problems;
}

std::vector<ActingEffect> acting_effects(const Machine& machine) {
  const std::vector<MachineProblem> problems = problems_of_effects(machine);
  if (!problems.empty()) {
    const MachineProblem& first = problems.front();
    throw std::invalid_argument(
        fmt::format("{}: found {}, expected {}", first.parameter, first.value, first.expected));
  }
  std::vector<ActingEffect> acting;
  for (const AppliedEffect& applied : machine.effects) {
    const Effect* effect = find_effect(machine, applied.effect);
    ActingEffect one{effect, *find_side(*effect, applied.side), {}};
    for (const EffectParameter& parameter : effect->parameters) {
      one.values.push_back(applied.parameters.at(std::string(parameter.name)));
    }
    acting.push_back(std::move(one));
  }
  std::stable_sort(acting.begin(), acting.end(), [](const ActingEffect& a, const ActingEffect& b) {
    return std::pair(order_of(*a.effect), a.effect->id) <
           std::pair(order_of(*b.effect), b.effect->id);
  });
  return acting;
}

AppliedEffect applied(const Effect& effect, EffectSide side, Values values) {
  if (values.size() != effect.parameters.size()) {
    throw std::invalid_argument(fmt::format(
        "effect {} takes {} values, not {}", effect.id, effect.parameters.size(), values.size()));
  }
  AppliedEffect result{std::string(effect.id), std::string(name(side)), {}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.parameters.emplace(effect.parameters[i].name, values[i]);
  }
  return result;
}

std::vector<double> null_values(const Effect& effect) {
  std::vector<double> values;
  for (const EffectParameter& parameter : effect.parameters) values.push_back(parameter.null);
  return values;
}

std::vector<double> nominal_values(const Effect& effect) {
  std::vector<double> values;
  for (const EffectParameter& parameter : effect.parameters) values.push_back(parameter.nominal);
  return values;
}

ActingEffect mirrored(const ActingEffect& acting) {
  ActingEffect image{acting.effect, mirrored(acting.side), acting.values};
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] *= acting.effect->parameters[i].mirror_sign;
  }
  return image;
}

}  // namespace chaintrue::model::effects
