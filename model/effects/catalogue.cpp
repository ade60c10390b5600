// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/catalogue.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "model/effects/declared_effect.hpp"

namespace chaintrue::model::effects {

namespace {

/// The catalogue with the declared effects, each in the place of the effect that it replaces, or at
/// the end.
std::vector<const Effect*> table_of(const Machine& machine, bool with_replaced) {
  std::vector<const Effect*> all;
  const auto declared_for = [&](const Effect* stood) {
    std::vector<const Effect*> own;
    for (const Effect* declared : machine.declared)
      if (find_effect(declaration_of(*declared)->instead_of) == stood) own.push_back(declared);
    return own;
  };
  for (const Effect* effect : catalogue()) {
    const std::vector<const Effect*> own = declared_for(effect);
    if (own.empty() || with_replaced) all.push_back(effect);
    all.insert(all.end(), own.begin(), own.end());
  }
  const std::vector<const Effect*> more = declared_for(nullptr);
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

bool has(const Attachment& attachment, Part part) {
  const bool ring = std::holds_alternative<Ring>(attachment);
  return part == Part::none || (part == Part::ring && ring) || (part == Part::brackets && !ring);
}

// Ranges of the sums of the machine's own numbers and its effects.
void check_sums(const Machine& machine, std::vector<MachineProblem>& problems) {
  EquilibriumParameters parameters = equilibrium_parameters(machine);
  for (std::size_t i = 0; i < machine.effects.size(); ++i) {
    const AppliedEffect& named = machine.effects[i];
    const Effect& effect = *find_effect(machine, named.effect);
    if (effect.alter == nullptr) continue;
    const std::string place = fmt::format("/{}", i);
    if (!has(machine.attachment, effect.part)) {
      problems.push_back(
          {place + "/effect", named.effect, fmt::format("{} to act on", name(effect.part))});
      continue;
    }
    effect.alter(parameters, resolve(std::array{&effect}, {named}).front().values);
    const auto* ring = std::get_if<Ring>(&parameters.attachment);
    const auto* brackets = std::get_if<Brackets>(&parameters.attachment);
    const bool sound =
        parameters.sprocket_radius_mm > 0.0 && parameters.chain_weight_n_per_mm > 0.0 &&
        parameters.chain_compliance_per_n >= 0.0 && (ring == nullptr || ring->radius_mm >= 0.0) &&
        (brackets == nullptr || (brackets->spacing_mm > 0.0 && brackets->height_mm >= 0.0));
    if (!sound) {
      problems.push_back(
          {place, named.effect,
           "together with the machine's values: sprocket radius, chain mass and spacing of "
           "brackets above 0, ring radius, height of brackets and compliance not below 0"});
      return;
    }
  }
}

}  // namespace

const Effect* find_effect(std::string_view id) { return find_effect(catalogue(), id); }

std::vector<const Effect*> listed_effects(const Machine& machine) {
  return table_of(machine, false);
}

std::vector<const Effect*> effects_of(const Machine& machine) {
  std::vector<const Effect*> all = listed_effects(machine);
  std::erase_if(all, [&](const Effect* effect) { return !has(machine.attachment, effect->part); });
  return all;
}

const Effect* find_effect(const Machine& machine, std::string_view id) {
  return find_effect(table_of(machine, true), id);
}

std::vector<MachineProblem> problems_of_effects(const Machine& machine) {
  std::vector<MachineProblem> problems =
      problems_in(table_of(machine, true), machine.effects, true);
  if (problems.empty()) check_sums(machine, problems);
  for (MachineProblem& problem : problems) problem.parameter = "/effects" + problem.parameter;
  return problems;
}

std::vector<ActingEffect> acting_effects(const Machine& machine) {
  require_none(problems_of_effects(machine));
  return resolve(table_of(machine, true), machine.effects);
}

AppliedEffect applied(const Effect& effect, EffectSide side, Values values) {
  if (values.size() != effect.parameters.size()) {
    throw std::invalid_argument(fmt::format("effect {} takes {} values, not {}", effect.id,
                                            effect.parameters.size(), values.size()));
  }
  AppliedEffect result{std::string(effect.id), std::string(name(side)), {}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.parameters.emplace(effect.parameters[i].name, values[i]);
  }
  return result;
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
