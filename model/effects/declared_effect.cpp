// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/declared_effect.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include "model/effects/declared_law.hpp"

namespace chaintrue::model::effects {
namespace {

std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = name.find('_');
    parts.push_back(name.substr(0, end));
    if (end == std::string_view::npos) return parts;
    name = name.substr(end + 1);
  }
}

struct UnitWord {
  std::string_view word;
  std::optional<FormulaUnit> unit;  ///< empty: a unit that formulas do not know
};

// Last words of names that are units; any other last word means a plain number.
constexpr std::array kUnitWords = {
    UnitWord{"mm", FormulaUnit{.mm = 1.0}},
    UnitWord{"mm2", FormulaUnit{.mm = 2.0}},
    UnitWord{"mm3", FormulaUnit{.mm = 3.0}},
    UnitWord{"n", FormulaUnit{.n = 1.0}},
    UnitWord{"n2", FormulaUnit{.n = 2.0}},
    UnitWord{"rad", FormulaUnit{}},
    UnitWord{"visit", FormulaUnit{}},
    UnitWord{"visits", FormulaUnit{}},
    UnitWord{"deg", std::nullopt},
    UnitWord{"mrad", std::nullopt},
    UnitWord{"m", std::nullopt},
    UnitWord{"cm", std::nullopt},
    UnitWord{"um", std::nullopt},
    UnitWord{"in", std::nullopt},
    UnitWord{"kg", std::nullopt},
    UnitWord{"percent", std::nullopt},
};

const UnitWord* find_unit(std::string_view word) {
  const auto found = std::find_if(kUnitWords.begin(), kUnitWords.end(),
                                  [&](const UnitWord& u) { return u.word == word; });
  return found == kUnitWords.end() ? nullptr : &*found;
}

/// One declared effect for each declaration, for the life of the program.
class Declared {
 public:
  const DeclaredLaw& law(const Declaration& declaration) {
    const std::scoped_lock lock(mutex_);
    for (const auto& known : laws_) {
      if (known->stated == declaration) return known->law;
    }
    laws_.push_back(std::make_unique<Known>(declaration));
    return laws_.back()->law;
  }

 private:
  struct Known {
    explicit Known(const Declaration& declaration) : stated(declaration), law(declaration) {}
    Declaration stated;
    DeclaredLaw law;
  };
  std::mutex mutex_;
  std::vector<std::unique_ptr<Known>> laws_;
};

}  // namespace

std::optional<FormulaUnit> unit_of_name(std::string_view name) {
  const std::vector<std::string_view> parts = parts_of(name);
  const UnitWord* last = find_unit(parts.back());
  if (last == nullptr) return FormulaUnit{};
  if (!last->unit) return std::nullopt;
  if (parts.size() < 2 || parts[parts.size() - 2] != "per") return last->unit;
  FormulaUnit unit{-last->unit->mm, -last->unit->n};
  if (parts.size() < 3) return unit;
  const UnitWord* above = find_unit(parts[parts.size() - 3]);
  if (above == nullptr) return unit;
  if (!above->unit) return std::nullopt;
  return FormulaUnit{unit.mm + above->unit->mm, unit.n + above->unit->n};
}

const Effect& declared_effect(const Declaration& declaration) {
  // Never destroyed: effects are referred to until the end.
  static auto* const all = new Declared;
  return all->law(declaration).effect();
}

const Declaration* declaration_of(const Effect& effect) {
  return effect.law == nullptr ? nullptr : &effect.law->declaration();
}

PlaceVariable place_variable(const Effect& effect) {
  if (effect.law == nullptr || effect.parameters.size() < 2)
    throw std::invalid_argument("place_variable: a declared effect with a place");
  const EffectParameter& place = effect.parameters.back();
  // One turn, written with two digits.
  constexpr double kTurn = 6.2;
  if (place.name.ends_with("_rad") && place.upper - place.lower >= kTurn)
    return PlaceVariable::phase;
  const FormulaUnit unit = *unit_of_name(place.name);
  PlaceVariable found = PlaceVariable::none;
  for (const FormulaVariable& own : variables_of(effect.law->declaration().acts_on)) {
    if (own.place == PlaceVariable::none || own.unit != unit || !effect.law->uses(own.name))
      continue;
    if (found != PlaceVariable::none) return PlaceVariable::none;
    found = own.place;
  }
  return found;
}

std::string_view name(ActsOn acts_on) {
  constexpr std::array<std::string_view, 4> kNames = {"paper", "chain", "reading", "visit"};
  return kNames.at(static_cast<std::size_t>(acts_on));
}

}  // namespace chaintrue::model::effects
