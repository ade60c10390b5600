// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Checks of a declaration, except those of its formulas on a bed (declared_bed_checks.cpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "model/effects/catalogue.hpp"
#include "model/effects/declared_law.hpp"

namespace chaintrue::model::effects {
namespace {

using Problems = std::vector<DeclarationProblem>;

constexpr std::size_t kMostDeclared = 2;

bool is_identifier(std::string_view text) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.front() >= 'a' && text.front() <= 'z' &&
         std::all_of(text.begin(), text.end(), fits);
}

bool can_be_written(const Effect& effect) { return effect.station != Station::machine; }

void check_names(const Declaration& own, Problems& problems) {
  if (!is_identifier(own.id)) {
    problems.push_back(
        {"/id", own.id, "a name of small letters, digits and _, such as second_harmonic"});
  } else if (find_effect(own.id) != nullptr) {
    problems.push_back(
        {"/id", own.id,
         "another name, because the catalogue has an effect with this one; to replace it, use "
         "\"instead_of\""});
  }
  if (own.instead_of.empty()) return;
  const Effect* stood = find_effect(own.instead_of);
  if (stood == nullptr || !can_be_written(*stood)) {
    problems.push_back({"/instead_of", own.instead_of,
                        stood == nullptr
                            ? "an effect of the catalogue, as chaintrue effects lists them"
                            : "an effect of paper, chain or reading, because formulas cannot "
                              "change the equilibrium"});
  }
}

void check_sides(const Declaration& own, Problems& problems) {
  const bool paper = own.acts_on == ActsOn::paper;
  for (std::size_t i = 0; i < own.sides.size(); ++i) {
    const EffectSide side = own.sides[i];
    const bool axis = side == EffectSide::x || side == EffectSide::y;
    const bool chain = side == EffectSide::left || side == EffectSide::right;
    if (std::count(own.sides.begin(), own.sides.begin() + static_cast<std::ptrdiff_t>(i), side) >
        0) {
      problems.push_back({fmt::format("/sides/{}", i), std::string(name(side)), "each side once"});
    } else if (paper ? chain : axis) {
      problems.push_back({fmt::format("/sides/{}", i), std::string(name(side)),
                          paper ? "x, y or both, because it acts on the paper"
                                : "left, right or both, because it acts on a chain"});
    }
  }
}

void check_range(const DeclaredParameter& p, const std::string& at, Problems& problems) {
  if (!(p.lower < p.upper)) {
    problems.push_back({at + "/lower", fmt::format("{}", p.lower), "a number below \"upper\""});
    return;
  }
  const auto within = [&](double value, std::string_view key) {
    if (value >= p.lower && value <= p.upper && (!p.integer || value == std::round(value))) return;
    problems.push_back({fmt::format("{}/{}", at, key), fmt::format("{}", value),
                        fmt::format("{} from \"lower\" {} to \"upper\" {}",
                                    p.integer ? "a whole number" : "a number", p.lower, p.upper)});
  };
  within(p.nominal, "nominal");
  if (p.role == ParameterRole::place) return;
  within(p.null, "null");
  if (p.nominal == p.null) {
    problems.push_back({at + "/nominal", fmt::format("{}", p.nominal),
                        "the usual size, which is not the value without effect"});
  }
}

void check_parameter(const Declaration& own, std::size_t index, Problems& problems) {
  const DeclaredParameter& p = own.parameters[index];
  const std::string at = fmt::format("/parameters/{}", index);
  const bool first = index == 0;
  if ((p.role == ParameterRole::size) != first) {
    problems.push_back({at + "/role", first ? "place" : "size",
                        first
                            ? "a size, because the first parameter is the size of the effect"
                            : "a place, because an effect has one size and at most one place after "
                              "it"});
  }
  std::set<std::string> taken = {"pi",   "mm",  "sin", "cos", "exp",  "log",
                                 "sqrt", "abs", "min", "max", "step", "ramp"};
  for (const FormulaVariable& variable : variables_of(own.acts_on)) taken.emplace(variable.name);
  for (std::size_t i = 0; i < index; ++i) taken.insert(own.parameters[i].name);
  if (!is_identifier(p.name) || taken.contains(p.name)) {
    problems.push_back(
        {at + "/name", p.name,
         "a name of small letters, digits and _ that nothing else in the formula has"});
  } else if (!unit_of_name(p.name)) {
    problems.push_back(
        {at + "/name", p.name,
         "a name that ends in a unit: mm, n, rad, visit, one per another as in mm_per_rad, or none "
         "for a plain number"});
  }
  if (!(p.prior_sigma > 0.0)) {
    problems.push_back({at + "/prior_sigma", fmt::format("{}", p.prior_sigma), "a number above 0"});
  }
  if (p.integer && own.acts_on != ActsOn::reading && own.acts_on != ActsOn::visit) {
    problems.push_back(
        {at + "/whole", "true",
         "false, because only an effect on readings or on one visit uses whole numbers"});
  }
  check_range(p, at, problems);
}

void check_parameters(const Declaration& own, Problems& problems) {
  if (own.parameters.empty() || own.parameters.size() > kMostDeclared) {
    problems.push_back({"/parameters", fmt::format("{} parameters", own.parameters.size()),
                        "one size, and at most one place after it"});
    return;
  }
  for (std::size_t i = 0; i < own.parameters.size(); ++i) check_parameter(own, i, problems);
  if (own.acts_on == ActsOn::visit && (own.parameters.size() < 2 || !own.parameters[1].integer)) {
    problems.push_back({"/parameters", fmt::format("{} parameters", own.parameters.size()),
                        "a size and a place with \"whole\": true, the number of the visit"});
  }
}

bool belongs(ActsOn acts_on, FormulaKey key) {
  if (acts_on == ActsOn::paper) return key == FormulaKey::adds_x_mm || key == FormulaKey::adds_y_mm;
  return key == FormulaKey::adds_mm || (acts_on == ActsOn::chain && key == FormulaKey::elongation);
}

std::string keys_of(ActsOn acts_on) {
  if (acts_on == ActsOn::paper) return "\"adds_x_mm\" or \"adds_y_mm\" or both";
  return acts_on == ActsOn::chain ? "\"adds_mm\" or \"elongation\"" : "\"adds_mm\"";
}

bool states(const Declaration& own, EffectSide axis) {
  return std::any_of(own.sides.begin(), own.sides.end(),
                     [axis](EffectSide side) { return side == axis || side == EffectSide::both; });
}

/// Checks which formulas are stated; true if these can be parsed.
bool check_keys(const Declaration& own, Problems& problems) {
  const std::size_t before = problems.size();
  int stated = 0;
  for (const FormulaRow& one : kFormulas) {
    if ((own.*one.text).empty()) continue;
    ++stated;
    if (!belongs(own.acts_on, one.key)) {
      problems.push_back({fmt::format("/{}", one.name), own.*one.text,
                          fmt::format("{}: it acts on {}", keys_of(own.acts_on),
                                      own.acts_on == ActsOn::chain   ? "a chain"
                                      : own.acts_on == ActsOn::paper ? "the paper"
                                                                     : "readings")});
    }
  }
  const bool paper = own.acts_on == ActsOn::paper;
  if (stated == 0 || (stated > 1 && !paper)) {
    problems.push_back({"", stated == 0 ? "no formula" : fmt::format("{} formulas", stated),
                        stated == 0 ? keys_of(own.acts_on) : "one of " + keys_of(own.acts_on)});
  }
  for (const auto& [axis, text, key] : {std::tuple{EffectSide::x, &own.adds_x_mm, "/adds_x_mm"},
                                        {EffectSide::y, &own.adds_y_mm, "/adds_y_mm"}}) {
    if (!paper) continue;
    if (states(own, axis) && text->empty())
      problems.push_back({key, "", fmt::format("a formula: it acts along {}", name(axis))});
    const bool may_act = own.sides.empty() || states(own, axis) || states(own, EffectSide::none);
    if (!text->empty() && !may_act)
      problems.push_back({key, *text, fmt::format("no formula, or the side {}", name(axis))});
  }
  return problems.size() == before;
}

void check_formula(const Declaration& own, const FormulaRow& one, std::vector<bool>& used,
                   Problems& problems) {
  if ((own.*one.text).empty()) return;
  const std::vector<FormulaName> names = names_of(own, one.key);
  const std::string place = fmt::format("/{}", one.name);
  const auto formula = parsed(own, one);
  if (!formula) {
    const FormulaProblem& problem = formula.error();
    problems.push_back({place, problem.found, problem.expected, problem.offset});
    // The names that it uses are unknown, so unused parameters are not reported.
    used.assign(used.size(), true);
    return;
  }
  bool direction = false;
  bool state = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!formula->uses(i)) continue;
    if (i < used.size()) {
      used[i] = true;
    } else {
      (own.acts_on == ActsOn::chain && names[i].name == "d" ? direction : state) = true;
    }
  }
  if (direction && state) {
    problems.push_back(
        {place, "d together with other values of the chain",
         "d with parameters only; play that changes from place to place cannot be declared", 0});
  }
}

void check_formulas(const Declaration& own, Problems& problems) {
  std::vector<bool> used(own.parameters.size(), false);
  // For an effect at one visit, the place gives the visit.
  if (own.acts_on == ActsOn::visit && used.size() > 1) used[1] = true;
  for (const FormulaRow& one : kFormulas) check_formula(own, one, used, problems);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) continue;
    problems.push_back({fmt::format("/parameters/{}/name", i), own.parameters[i].name,
                        "a parameter that the formula uses, or none"});
  }
}

}  // namespace

std::vector<DeclarationProblem> problems_of(const Declaration& declaration) {
  Problems problems;
  check_names(declaration, problems);
  check_sides(declaration, problems);
  const std::size_t before = problems.size();
  check_parameters(declaration, problems);
  const bool parameters_sound = problems.size() == before;
  if (check_keys(declaration, problems) && parameters_sound) check_formulas(declaration, problems);
  return problems;
}

}  // namespace chaintrue::model::effects
