// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/declared_law.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace chaintrue::model::effects {
namespace {

constexpr FormulaUnit kMm{.mm = 1.0};
constexpr FormulaUnit kNewton{.n = 1.0};

Number added_by(const DeclaredLaw& law, const LengthState& state, Values values) {
  if (law.effect().at_one_visit && state.order != values.back()) return {};
  return law.value(FormulaKey::adds_mm, state, values);
}

double elongation_of(const DeclaredLaw& law, Values values) {
  return law.value(FormulaKey::elongation, {}, values).value;
}

MarkPoint written_at(const DeclaredLaw& law, MarkPoint mark, EffectSide side, Values values) {
  const LengthState at{.x_mm = mark.x_mm, .y_mm = mark.y_mm};
  MarkPoint written = mark;
  if (law.formula(FormulaKey::adds_x_mm) && side != EffectSide::y)
    written.x_mm += law.value(FormulaKey::adds_x_mm, at, values).value;
  if (law.formula(FormulaKey::adds_y_mm) && side != EffectSide::x)
    written.y_mm += law.value(FormulaKey::adds_y_mm, at, values).value;
  return written;
}

/// At the middle itself the distance has no slope; 0 is its mean over all directions.
Number distance_of(const LengthState& s) {
  const Number square = s.x_mm * s.x_mm + s.y_mm * s.y_mm;
  return square.value > 0.0 ? sqrt(square) : Number{};
}

constexpr FormulaVariable kOfPaper[] = {
    {"x", kMm, [](const LengthState& s) { return s.x_mm; }},
    {"y", kMm, [](const LengthState& s) { return s.y_mm; }},
};
constexpr FormulaVariable kOfChain[] = {
    {"phi", {}, [](const LengthState& s) { return s.angle_rad; }, PlaceVariable::angle},
    {"S", kMm, [](const LengthState& s) { return s.free_mm; }, PlaceVariable::free_length},
    {"L0", kMm, [](const LengthState& s) { return s.length_mm; }, PlaceVariable::length},
    {"T", kNewton, [](const LengthState& s) { return s.tension; }, PlaceVariable::tension},
    {"H", kNewton, [](const LengthState& s) { return s.horizontal_n; }, PlaceVariable::horizontal},
    {"x", kMm, kOfPaper[0].of, PlaceVariable::x},
    {"y", kMm, kOfPaper[1].of, PlaceVariable::y},
    {"turn", kMm, [](const LengthState& s) { return Number(s.turn_mm); }},
    {"pitch", kMm, [](const LengthState& s) { return Number(s.tooth_mm); }},
    {"r", kMm, distance_of, PlaceVariable::distance},
    {"d", {}, [](const LengthState& s) { return Number(s.direction); }},
    {"side", {}, [](const LengthState& s) { return Number(s.side); }},
};
constexpr FormulaVariable kOfReading[] = {
    {"n", {}, [](const LengthState& s) { return Number(s.order); }, PlaceVariable::visit},
    kOfChain[8],
};

}  // namespace

std::span<const FormulaVariable> variables_of(ActsOn acts_on) {
  switch (acts_on) {
    case ActsOn::paper:
      return kOfPaper;
    case ActsOn::chain:
      return kOfChain;
    default:
      return kOfReading;
  }
}

std::vector<Number> values_at(ActsOn acts_on, const LengthState& state, Values parameters) {
  std::vector<Number> values(parameters.begin(), parameters.end());
  for (const FormulaVariable& variable : variables_of(acts_on))
    values.push_back(variable.of(state));
  return values;
}

std::vector<FormulaName> names_of(const Declaration& declaration, FormulaKey key) {
  std::vector<FormulaName> names;
  for (const DeclaredParameter& parameter : declaration.parameters)
    names.push_back({parameter.name, unit_of_name(parameter.name).value_or(FormulaUnit{})});
  if (key == FormulaKey::elongation) return names;
  for (const FormulaVariable& variable : variables_of(declaration.acts_on))
    names.push_back({std::string(variable.name), variable.unit});
  return names;
}

tl::expected<Formula, FormulaProblem> parsed(const Declaration& declaration,
                                             const FormulaRow& row) {
  return Formula::parse(declaration.*row.text, names_of(declaration, row.key),
                        row.key == FormulaKey::elongation ? FormulaUnit{} : kMm);
}

DeclaredLaw::DeclaredLaw(const Declaration& declaration) : declaration_(declaration) {
  for (const FormulaRow& row : kFormulas) {
    if ((declaration.*row.text).empty()) continue;
    auto formula = parsed(declaration, row);
    if (!formula) {
      const FormulaProblem& problem = formula.error();
      throw std::invalid_argument(fmt::format("{}: {}: found {}, expected {}", declaration.id,
                                              problem.offset, problem.found, problem.expected));
    }
    formulas_[static_cast<std::size_t>(row.key)] = *std::move(formula);
  }
  sides_ = declaration.sides;
  if (sides_.empty()) sides_ = {EffectSide::none};
  for (const DeclaredParameter& p : declaration_.parameters) {
    effect_.parameters.push_back({.name = p.name,
                                  .symbol = p.symbol,
                                  .meaning = p.meaning,
                                  .role = p.role,
                                  .null = p.null,
                                  .nominal = p.nominal,
                                  .lower = p.lower,
                                  .upper = p.upper,
                                  .prior_sigma = p.prior_sigma,
                                  .integer = p.integer,
                                  .mirror_sign = p.mirror_sign});
  }
  describe();
  connect();
}

void DeclaredLaw::describe() {
  const Declaration& own = declaration_;
  if (!own.elongation.empty()) equation_ = fmt::format("L / (1 + {})", own.elongation);
  if (!own.adds_mm.empty()) equation_ = fmt::format("+ {}", own.adds_mm);
  if (!own.adds_x_mm.empty()) equation_ = fmt::format("x_written = x + {}", own.adds_x_mm);
  if (!own.adds_y_mm.empty())
    equation_ += fmt::format("{}y_written = y + {}", equation_.empty() ? "" : "; ", own.adds_y_mm);
  effect_.id = own.id;
  effect_.sides = sides_;
  effect_.cause = own.cause;
  effect_.signature = own.signature;
  effect_.equation = equation_;
  effect_.source = own.source;
  effect_.not_modelled = own.not_modelled;
  effect_.typical = own.typical;
  effect_.remedy_kind = own.remedy_kind;
  effect_.remedy = own.remedy;
  effect_.law = this;
}

void DeclaredLaw::connect() {
  switch (declaration_.acts_on) {
    case ActsOn::paper:
      effect_.station = Station::paper;
      effect_.write = {*this, written_at};
      break;
    case ActsOn::chain:
      effect_.station = Station::chain;
      if (formula(FormulaKey::elongation)) {
        effect_.elongation = {*this, elongation_of};
      } else {
        effect_.add = {*this, added_by};
        effect_.by_direction = uses("d");
      }
      break;
    default:
      effect_.station = Station::reading;
      effect_.add = {*this, added_by};
      effect_.at_one_visit = declaration_.acts_on == ActsOn::visit;
      break;
  }
  effect_.needs = depends_on_visit(effect_) ? DataNeed::order : DataNeed::positions;
}

Number DeclaredLaw::value(FormulaKey key, const LengthState& state, Values parameters) const {
  const std::vector<Number> values = values_at(declaration_.acts_on, state, parameters);
  return formula(key)->evaluate(std::span<const Number>(values));
}

bool DeclaredLaw::uses(std::string_view name) const {
  for (const FormulaRow& row : kFormulas) {
    if (!formula(row.key)) continue;
    const std::vector<FormulaName> names = names_of(declaration_, row.key);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].name == name && formula(row.key)->uses(i)) return true;
    }
  }
  return false;
}

}  // namespace chaintrue::model::effects
