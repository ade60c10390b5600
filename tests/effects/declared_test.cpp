// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Declared effects: problems of a declaration, units of names, and variables of places.
#include <gmock/gmock.h>

#include "model/effects/catalogue.hpp"
#include "model/effects/declared_effect.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::model::effects::declared {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

DeclaredParameter size(const std::string& name) {
  return {.name = name,
          .symbol = name,
          .meaning = "how large",
          .nominal = 0.2,
          .lower = -5.0,
          .upper = 5.0,
          .prior_sigma = 0.2};
}

DeclaredParameter place(const std::string& name, double lower, double upper) {
  const double middle = 0.5 * (lower + upper);
  return {.name = name,
          .symbol = name,
          .meaning = "where",
          .role = ParameterRole::place,
          .null = middle,
          .nominal = middle,
          .lower = lower,
          .upper = upper,
          .prior_sigma = 1.0};
}

Declaration wave() {
  Declaration own;
  own.id = "wave";
  own.sides = {EffectSide::left, EffectSide::right};
  own.parameters = {size("amplitude_mm"), place("phase_rad", -6.3, 6.3)};
  own.adds_mm = "amplitude_mm * sin(4 * pi * L0 / turn + phase_rad)";
  own.cause = own.remedy = own.not_modelled = own.signature = own.typical = own.source = "words";
  return own;
}

/// For one problem: its place, then what was found, then what was expected.
std::string only_problem(const std::vector<DeclarationProblem>& problems) {
  if (problems.size() != 1) return testing::PrintToString(problems.size()) + " problems";
  const DeclarationProblem& p = problems.front();
  return p.place + (p.offset ? "@" + std::to_string(*p.offset) : "") + ": " + p.value + ": " +
         p.expected;
}

std::string own_problem(const std::function<void(Declaration&)>& change) {
  Declaration own = wave();
  change(own);
  return only_problem(problems_of(own));
}

TEST(DeclaredEffect, BehavesLikeACatalogueEffect) {
  ASSERT_THAT(problems_of(wave()), IsEmpty());
  ASSERT_THAT(problems_on_bed(wave(), Machine{}), IsEmpty());
  const Effect& effect = declared_effect(wave());
  EXPECT_EQ(effect.station, Station::chain);
  EXPECT_NE(effect.add, nullptr);
  EXPECT_FALSE(depends_on_visit(effect));
  EXPECT_EQ(&effect, &declared_effect(wave())) << "equal declarations are one effect";
  Machine machine;
  machine.declared = {&effect};
  EXPECT_EQ(find_effect(machine, "wave"), &effect);
  EXPECT_EQ(find_effect("wave"), nullptr);
  EXPECT_EQ(effects_of(machine).size(), effects_of(Machine{}).size() + 1);
  EXPECT_EQ(effects_of(machine).back(), &effect);
}

TEST(DeclaredEffect, ReplacesACatalogueEffect) {
  Declaration own = wave();
  own.instead_of = "sprocket_eccentricity";
  Machine machine;
  machine.declared = {&declared_effect(own)};
  const std::vector<const Effect*> all = listed_effects(machine);
  ASSERT_EQ(all.size(), catalogue().size());
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(all[i]->id, catalogue()[i]->id == own.instead_of ? "wave" : catalogue()[i]->id);
}

TEST(DeclaredEffect, ADirectionMakesItAnEffectOfTheVisit) {
  Declaration own = wave();
  own.id = "play";
  own.parameters = {size("half_width_mm")};
  own.adds_mm = "half_width_mm * d";
  const Effect& effect = declared_effect(own);
  ASSERT_TRUE(effect.by_direction);
  const double values[] = {0.3};
  EXPECT_EQ(effect.add({.direction = 1.0}, values).value, 0.3);
  EXPECT_EQ(effect.add({.direction = -1.0}, values).value, -0.3);
  EXPECT_EQ(effect.needs, DataNeed::order);
}

TEST(DeclaredEffect, NamesEndInTheirUnit) {
  EXPECT_EQ(unit_of_name("amplitude_mm"), (FormulaUnit{.mm = 1.0}));
  EXPECT_EQ(unit_of_name("slope_mm_per_rad"), (FormulaUnit{.mm = 1.0}));
  EXPECT_EQ(unit_of_name("flexibility_mm_per_n"), (FormulaUnit{.mm = 1.0, .n = -1.0}));
  EXPECT_EQ(unit_of_name("compliance_per_n"), (FormulaUnit{.n = -1.0}));
  EXPECT_EQ(unit_of_name("bow_per_mm2"), (FormulaUnit{.mm = -2.0}));
  EXPECT_EQ(unit_of_name("rate_mm_per_visit"), (FormulaUnit{.mm = 1.0}));
  EXPECT_EQ(unit_of_name("elongation"), FormulaUnit{});
  EXPECT_EQ(unit_of_name("first_visit"), FormulaUnit{});
  EXPECT_EQ(unit_of_name("knee_deg"), std::nullopt);
  EXPECT_EQ(unit_of_name("rate_um_per_visit"), std::nullopt);
}

TEST(DeclaredEffect, APlaceIsComparedWithTheOneVariableOfItsUnit) {
  const auto variable = [](const DeclaredParameter& where, const std::string& formula) {
    Declaration own = wave();
    own.parameters[1] = where;
    own.adds_mm = formula;
    return place_variable(declared_effect(own));
  };
  EXPECT_EQ(variable(place("p_rad", -6.3, 6.3), "amplitude_mm * sin(L0 / turn + p_rad)"),
            PlaceVariable::phase);
  EXPECT_EQ(variable(place("p_rad", -1.5, 1.5), "amplitude_mm * ramp(phi - p_rad)"),
            PlaceVariable::angle);
  EXPECT_EQ(variable(place("p_mm", -900, 900), "amplitude_mm * step(x - p_mm)"), PlaceVariable::x);
  EXPECT_EQ(variable(place("p_mm", -900, 900), "amplitude_mm * step(y - p_mm)"), PlaceVariable::y);
  EXPECT_EQ(variable(place("p_mm", 0, 900), "amplitude_mm * step(r - p_mm)"),
            PlaceVariable::distance);
  EXPECT_EQ(variable(place("p_mm", 500, 3000), "amplitude_mm * step(S - p_mm)"),
            PlaceVariable::free_length);
  EXPECT_EQ(variable(place("p_mm", 500, 3000), "amplitude_mm * step(L0 - p_mm)"),
            PlaceVariable::length);
  EXPECT_EQ(variable(place("p_n", 10, 90), "amplitude_mm * step(T - p_n)"), PlaceVariable::tension);
  EXPECT_EQ(variable(place("p_n", 10, 90), "amplitude_mm * step(H - p_n)"),
            PlaceVariable::horizontal);
  EXPECT_EQ(variable(place("p_mm", 500, 3000), "amplitude_mm * sin(x / p_mm + y / p_mm)"),
            PlaceVariable::none);
}

TEST(DeclaredEffect, ReportsItsErrors) {
  const std::pair<std::function<void(Declaration&)>, const char*> slips[] = {
      {[](Declaration& d) { d.id = "drift"; },
       "/id: drift: another name, because the catalogue has an effect with this one; to replace "
       "it, use \"instead_of\""},
      {[](Declaration& d) { d.id = "Wave 2"; }, "/id: Wave 2: a name of small letters"},
      {[](Declaration& d) { d.instead_of = "chain_sag"; },
       "because formulas cannot change the equilibrium"},
      {[](Declaration& d) { d.instead_of = "rust"; }, "/instead_of: rust"},
      {[](Declaration& d) { d.sides = {EffectSide::x}; },
       "/sides/0: x: left, right or both, because it acts on a chain"},
      {[](Declaration& d) { d.parameters[0].lower = 9.0; },
       "/parameters/0/lower: 9: a number below \"upper\""},
      {[](Declaration& d) { d.parameters[0].nominal = 9.0; }, "/parameters/0/nominal: 9"},
      {[](Declaration& d) { d.parameters[0].nominal = 0.0; }, "not the value without effect"},
      {[](Declaration& d) { d.parameters[0].prior_sigma = 0.0; }, "above 0"},
      {[](Declaration& d) { d.parameters[1].name = "turn"; }, "nothing else in the formula has"},
      {[](Declaration& d) { d.parameters[1].name = "phase_deg"; }, "a name that ends in a unit"},
      {[](Declaration& d) {
         d.parameters[1].role = ParameterRole::size;
         d.parameters[1].null = -1.0;
       },
       "one size and at most one place"},
      {[](Declaration& d) {
         d.parameters[0].integer = true;
         d.parameters[0].nominal = 1.0;
       },
       "uses whole numbers"},
      {[](Declaration& d) { d.parameters.clear(); }, "0 parameters"},
      {[](Declaration& d) { d.adds_mm = "amplitude_mm * L0 / turn"; },
       "/parameters/1/name: phase_rad: a parameter that the formula uses, or none"},
      {[](Declaration& d) { d.adds_mm = "amplitude_mm * sin(phase)"; },
       "/adds_mm@19: phase: a name that this formula may use: amplitude_mm, phase_rad, phi, "
       "S, L0, T, H, x, y, turn, pitch, r, d, side, mm, N, pi"},
      {[](Declaration& d) { d.adds_mm = "amplitude_mm * T * sin(phase_rad)"; },
       "/adds_mm@0: a formula in mm N: one whose units come out as mm"},
      {[](Declaration& d) { d.adds_mm = "amplitude_mm * d * sin(phi + phase_rad)"; },
       "d with parameters only"},
      {[](Declaration& d) { d.adds_mm = ""; }, "no formula: \"adds_mm\" or \"elongation\""},
      {[](Declaration& d) {
         d.adds_x_mm = "amplitude_mm";
         d.adds_mm = "";
       },
       "it acts on a chain"},
      {[](Declaration& d) {
         d.acts_on = ActsOn::visit;
         d.adds_mm = "amplitude_mm";
       },
       "the number of the visit"}};
  for (const auto& [change, words] : slips) EXPECT_THAT(own_problem(change), HasSubstr(words));
}

TEST(DeclaredEffect, ReportsWhereItIsNotFinite) {
  Declaration own = wave();
  own.adds_mm = "amplitude_mm * log(0 * phase_rad + x / mm)";
  ASSERT_THAT(problems_of(own), IsEmpty());
  const std::string said = only_problem(problems_on_bed(own, Machine{}));
  EXPECT_THAT(said, HasSubstr("/adds_mm@15: not finite: "));
  EXPECT_THAT(
      said, HasSubstr("over the bed of the machine between the bounds; this one is not at (-1219, "
                      "-610) mm with amplitude_mm = -5"));
}

TEST(DeclaredEffect, ReportsANonFiniteSlope) {
  Declaration own = wave();
  own.parameters = {size("size_mm")};
  own.adds_mm = "size_mm * sqrt(abs(x) / mm)";
  EXPECT_THAT(only_problem(problems_on_bed(own, Machine{})), HasSubstr("at (0, "));
}

TEST(DeclaredEffect, ReportsWhereItIsNotZeroAtNull) {
  Declaration own = wave();
  own.adds_mm = "amplitude_mm + 0.1 * mm * sin(phase_rad + L0 / turn)";
  ASSERT_THAT(problems_of(own), IsEmpty());
  EXPECT_THAT(only_problem(problems_on_bed(own, Machine{})),
              HasSubstr("a formula that is 0 at null; this one is "));
}

TEST(DeclaredEffect, ThePaperMovesInProportion) {
  Declaration own = wave();
  own.acts_on = ActsOn::paper;
  own.sides = {};
  own.parameters = {size("bow_mm")};
  own.adds_mm = "";
  own.adds_y_mm = "bow_mm * (x / (1000 * mm))^2";
  ASSERT_THAT(problems_of(own), IsEmpty());
  EXPECT_THAT(only_problem(problems_on_bed(own, Machine{})),
              HasSubstr("a formula linear in x and y"));
  own.adds_y_mm = "bow_mm * x / (1000 * mm)";
  EXPECT_THAT(problems_on_bed(own, Machine{}), IsEmpty());
}

TEST(DeclaredEffect, AWholeSizeIsInProportion) {
  Declaration own = wave();
  own.acts_on = ActsOn::reading;
  own.parameters = {size("links")};
  own.parameters[0].integer = true;
  own.parameters[0].nominal = 1.0;
  own.adds_mm = "pitch * links^3";
  ASSERT_THAT(problems_of(own), IsEmpty());
  EXPECT_THAT(only_problem(problems_on_bed(own, Machine{})),
              HasSubstr("in proportion to a size in whole numbers"));
}

}  // namespace
}  // namespace chaintrue::model::effects::declared
