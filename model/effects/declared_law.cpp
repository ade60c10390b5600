// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/declared_law.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace chaintrue::model::effects {
namespace {

constexpr FormulaUnit kMm{.mm = 1.0};
constexpr FormulaUnit kNewton{.n = 1.0};

std::optional<Formula> parsed(const Declaration& declaration,
                              const std::string& text,
                              bool elongation) {
  if (text.empty()) return std::nullopt;
  auto formula =
      Formula::parse(text, names_of(declaration, elongation), elongation ? FormulaUnit{} : kMm);
  if (!formula) {
    const FormulaProblem& problem = formula.error();
    throw std::invalid_argument(fmt::format("{}: {}: found {}, expected {}",
                                            declaration.id,
                                            problem.offset,
                                            problem.found,
                                            problem.expected));
  }
  return *std::move(formula);
}

ChainAddition added_to_chain(const DeclaredLaw& law, const ChainAtRest& chain, Values values) {
  const ChainDual sum = law.adds()->evaluate(values_of(chain, 1.0, values).span());
  return {.length_mm = sum.value,
          .per_angle_mm_per_rad = sum.d[0],
          .per_free_length = sum.d[1],
          .per_length = sum.d[2],
          .per_tension_mm_per_n = sum.d[3],
          .per_horizontal_mm_per_n = sum.d[4],
          .per_x = sum.d[5],
          .per_y = sum.d[6]};
}

double added_by_direction(const DeclaredLaw& law, double direction, Values values) {
  return law.adds()->evaluate(values_of(ChainAtRest{}, direction, values).span()).value;
}

double elongation_of(const DeclaredLaw& law, Values values) {
  return law.elongation()->evaluate(values_of(values).span()).value;
}

double misread_at(const DeclaredLaw& law, const VisitNote& visit, Values values) {
  if (law.effect().at_one_visit && visit.order != values.back()) return 0.0;
  return law.adds()->evaluate(values_of(visit, values).span()).value;
}

MarkPoint written_at(const DeclaredLaw& law, MarkPoint mark, EffectSide side, Values values) {
  const ChainValues at = values_of(mark, values);
  MarkPoint written = mark;
  if (law.adds_x() && side != EffectSide::y)
    written.x_mm += law.adds_x()->evaluate(at.span()).value;
  if (law.adds_y() && side != EffectSide::x)
    written.y_mm += law.adds_y()->evaluate(at.span()).value;
  return written;
}

/// Parameters first.
ChainValues begun(Values parameters) {
  ChainValues values;
  for (const double parameter : parameters) values.all.at(values.count++) = parameter;
  return values;
}

}  // namespace

std::vector<FormulaName> variables_of(ActsOn acts_on) {
  switch (acts_on) {
    case ActsOn::paper:
      return {{"x", kMm}, {"y", kMm}};
    case ActsOn::chain:
      return {{"phi", {}},
              {"S", kMm},
              {"L0", kMm},
              {"T", kNewton},
              {"H", kNewton},
              {"x", kMm},
              {"y", kMm},
              {"turn", kMm},
              {"pitch", kMm},
              {"r", kMm},
              {"d", {}},
              {"side", {}}};
    default:
      return {{"n", {}}, {"pitch", kMm}};
  }
}

std::vector<FormulaName> names_of(const Declaration& declaration, bool elongation) {
  std::vector<FormulaName> names;
  for (const DeclaredParameter& parameter : declaration.parameters)
    names.push_back({parameter.name, unit_of_name(parameter.name).value_or(FormulaUnit{})});
  if (elongation) return names;
  const std::vector<FormulaName> variables = variables_of(declaration.acts_on);
  names.insert(names.end(), variables.begin(), variables.end());
  return names;
}

ChainValues values_of(const ChainAtRest& chain, double direction, Values parameters) {
  ChainValues values = begun(parameters);
  const auto variable = [](double value, int slope) { return ChainDual::variable(value, slope); };
  const ChainDual x = variable(chain.position.x_mm, 5);
  const ChainDual y = variable(chain.position.y_mm, 6);
  // At the middle itself the distance has no slope; 0 is its mean over all directions.
  const ChainDual square = x * x + y * y;
  const ChainDual distance = square.value > 0.0 ? sqrt(square) : ChainDual{};
  for (const ChainDual& value : {variable(chain.state.angle_rad, 0),
                                 variable(chain.state.free_length_mm, 1),
                                 variable(chain.length_mm, 2),
                                 variable(chain.state.tension_at_sprocket_n, 3),
                                 variable(chain.state.horizontal_n, 4),
                                 x,
                                 y,
                                 ChainDual(chain.turn_mm),
                                 ChainDual(chain.pitch_mm),
                                 distance,
                                 ChainDual(direction),
                                 ChainDual(chain.side)}) {
    values.all.at(values.count++) = value;
  }
  return values;
}

ChainValues values_of(const VisitNote& visit, Values parameters) {
  ChainValues values = begun(parameters);
  values.all.at(values.count++) = static_cast<double>(visit.order);
  values.all.at(values.count++) = visit.pitch_mm;
  return values;
}

ChainValues values_of(const MarkPoint& mark, Values parameters) {
  ChainValues values = begun(parameters);
  values.all.at(values.count++) = mark.x_mm;
  values.all.at(values.count++) = mark.y_mm;
  return values;
}

ChainValues values_of(Values parameters) { return begun(parameters); }

DeclaredLaw::DeclaredLaw(const Declaration& declaration)
    : declaration_(declaration),
      adds_(parsed(declaration, declaration.adds_mm, false)),
      adds_x_(parsed(declaration, declaration.adds_x_mm, false)),
      adds_y_(parsed(declaration, declaration.adds_y_mm, false)),
      elongation_(parsed(declaration, declaration.elongation, true)) {
  sides_ = declaration.sides;
  if (sides_.empty()) sides_ = {EffectSide::none};
  for (const DeclaredParameter& p : declaration_.parameters) {
    parameters_.push_back({.name = p.name,
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
  if (elongation_) equation_ = fmt::format("L / (1 + {})", own.elongation);
  if (adds_) equation_ = fmt::format("+ {}", own.adds_mm);
  if (adds_x_) equation_ = fmt::format("x_written = x + {}", own.adds_x_mm);
  if (adds_y_)
    equation_ += fmt::format("{}y_written = y + {}", equation_.empty() ? "" : "; ", own.adds_y_mm);
  effect_.id = own.id;
  effect_.sides = sides_;
  effect_.parameters = parameters_;
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
      if (elongation_) {
        effect_.elongation = {*this, elongation_of};
      } else if (uses("d")) {
        effect_.add_by_direction = {*this, added_by_direction};
      } else {
        effect_.add = {*this, added_to_chain};
      }
      break;
    default:
      effect_.station = Station::reading;
      effect_.misread = {*this, misread_at};
      effect_.at_one_visit = declaration_.acts_on == ActsOn::visit;
      break;
  }
  effect_.needs = depends_on_visit(effect_) ? DataNeed::order : DataNeed::positions;
}

bool DeclaredLaw::uses(std::string_view name) const {
  for (const auto* formula : {&adds_, &adds_x_, &adds_y_, &elongation_}) {
    if (!*formula) continue;
    const std::vector<FormulaName> names = names_of(declaration_, formula == &elongation_);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].name == name && (*formula)->uses(i)) return true;
    }
  }
  return false;
}

}  // namespace chaintrue::model::effects
