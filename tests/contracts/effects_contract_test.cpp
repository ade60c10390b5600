// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws of every effect of the catalogue, on every side, and of declared ones, beside those of the
/// effects of every mechanism (mechanism_effects_contract_test.cpp). An effect is included by its line in
/// chain_effects.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"
#include "tests/contracts/declared_examples.hpp"
#include "tests/contracts/session_numbers.hpp"

namespace chaintrue::model::effects {
namespace {

// An effect at a side, as the suite's parameter.
struct Case {
  const Effect* effect;
  EffectSide side;
};

std::string case_name(const ::testing::TestParamInfo<Case>& info) {
  const std::string side(name(info.param.side));
  return std::string(info.param.effect->id) + (side.empty() ? "" : "_" + side);
}

void PrintTo(const Case& c, std::ostream* os) { *os << c.effect->id << ":" << name(c.side); }

std::vector<Case> cases_of(std::span<const Effect* const> effects) {
  std::vector<Case> cases;
  for (const Effect* effect : effects) {
    for (const EffectSide side : effect->sides) cases.push_back({effect, side});
  }
  return cases;
}

/// A machine that has the part that an effect needs.
Machine machine_for(const Effect& effect) {
  Machine machine;
  if (effect.part == Part::brackets) machine.attachment = Brackets{};
  machine.declared = declared_examples();
  return machine;
}

/// Another effect of each station, of the first and last that may act together with it.
std::vector<Case> partners_of(const Effect& effect) {
  std::vector<Case> partners;
  const std::vector<Case> all = cases_of(effects_of(machine_for(effect)));
  for (const Station station :
       {Station::paper, Station::machine, Station::chain, Station::reading}) {
    const auto fits = [&](const Case& c) {
      return c.effect != &effect && c.effect->law == nullptr && c.effect->station == station;
    };
    const auto first = std::find_if(all.begin(), all.end(), fits);
    if (first == all.end()) continue;
    partners.push_back(*first);
    const auto last = std::find_if(all.rbegin(), all.rend(), fits);
    if (last->effect != first->effect) partners.push_back(*last);
  }
  return partners;
}

// Sizes times `share` (whole numbers unchanged), places unchanged.
std::vector<double> scaled(const Effect& effect, std::vector<double> values, double share) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const EffectParameter& p = effect.parameters[i];
    if (p.role == ParameterRole::size && !p.integer) values[i] *= share;
  }
  return values;
}

class EffectContract : public ::testing::TestWithParam<Case> {
 protected:
  const Effect& effect() const { return *GetParam().effect; }
  EffectSide side() const { return GetParam().side; }
  [[nodiscard]] AppliedEffect with(const std::vector<double>& values) const {
    return applied(effect(), side(), values);
  }
  Machine machine_with(const std::vector<AppliedEffect>& effects) const {
    Machine machine = machine_for(effect());
    machine.effects = effects;
    return machine;
  }
  std::vector<double> seen_with(const std::vector<AppliedEffect>& effects) const {
    return found(machine_with(effects), session());
  }
};

// The diagnosis uses one column for all whole numbers of links.
TEST_P(EffectContract, AWholeNumberIsMisreadInProportion) {
  const Effect& e = effect();
  if (!e.parameters.front().integer) return;
  ASSERT_EQ(e.station, Station::reading);
  std::vector<double> values = nominal_values(e);
  for (const int visit : {0, 9, 10, 11, 30}) {
    values.front() = 1.0;
    const LengthState length{.tooth_mm = 6.35, .order = visit};
    const double one = e.add(length, values).value;
    for (const double links : {-3.0, -1.0, 2.0, 5.0}) {
      values.front() = links;
      EXPECT_NEAR(e.add(length, values).value, links * one, 1e-13) << visit;  // rounding
    }
  }
}

TEST_P(EffectContract, HasExactlyOneStation) {
  const Effect& e = effect();
  const int paper = e.write != nullptr;
  const int machine = e.alter != nullptr;
  const int length = (e.add != nullptr) + (e.elongation != nullptr);
  EXPECT_EQ(paper + machine + length, 1);
  EXPECT_EQ(paper, e.station == Station::paper);
  EXPECT_EQ(machine, e.station == Station::machine);
  EXPECT_EQ(length, e.station == Station::chain || e.station == Station::reading);
  EXPECT_EQ(depends_on_visit(e), e.needs == DataNeed::order);
}

TEST_P(EffectContract, StatesWhetherItActsAtOneVisitOnly) {
  const std::vector<double> usual = seen_with({with(nominal_values(effect()))});
  const std::vector<double> without = seen_with({});
  ASSERT_EQ(usual.size(), without.size());
  constexpr std::size_t kNumbersAVisit = 4;
  std::size_t acts = 0;
  for (std::size_t i = 0; i < usual.size(); i += kNumbersAVisit) {
    const auto at = static_cast<std::ptrdiff_t>(i);
    acts += std::equal(usual.begin() + at,
                       usual.begin() + at + static_cast<std::ptrdiff_t>(kNumbersAVisit),
                       without.begin() + at)
                ? 0
                : 1;
  }
  EXPECT_EQ(acts == 1, effect().at_one_visit) << acts << " visits are touched";
}

TEST_P(EffectContract, EveryParameterIsVisible) {
  constexpr double kVisibleMm = 1e-3;  // 1 um, below any tape and far above rounding
  const std::vector<double> nominal = nominal_values(effect());
  const std::vector<double> usual = seen_with({with(nominal)});
  EXPECT_GT(largest_difference(usual, seen_with({})), kVisibleMm);
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    const EffectParameter& p = effect().parameters[i];
    SCOPED_TRACE(std::string(p.name));
    std::vector<double> other = nominal;
    other[i] = p.integer ? nominal[i] + 1.0 : nominal[i] + 0.3 * p.prior_sigma;
    EXPECT_GT(largest_difference(usual, seen_with({with(other)})), kVisibleMm);
  }
}

TEST_P(EffectContract, ActsOnItsOwnSideOnly) {
  const std::vector<double> plain = seen_with({});
  const std::vector<double> changed = seen_with({with(nominal_values(effect()))});
  for (std::size_t i = 0; i < plain.size(); i += 4) {
    if (effect().station != Station::paper) {
      EXPECT_EQ(plain[i], changed[i]);
      EXPECT_EQ(plain[i + 1], changed[i + 1]);
    } else {
      EXPECT_EQ(plain[i + 2], changed[i + 2]);
      EXPECT_EQ(plain[i + 3], changed[i + 3]);
    }
    if (side() == EffectSide::right) {
      EXPECT_EQ(plain[i + 2], changed[i + 2]);
    }
    if (side() == EffectSide::left) {
      EXPECT_EQ(plain[i + 3], changed[i + 3]);
    }
    if (side() == EffectSide::x) {
      EXPECT_EQ(plain[i + 1], changed[i + 1]);
    }
    if (side() == EffectSide::y) {
      EXPECT_EQ(plain[i], changed[i]);
    }
  }
}

// The mirror image of the machine, visited at the mirror images of the points, has left and right
// readings exchanged.
TEST_P(EffectContract, HasAMirrorImage) {
  std::vector<Visit> visits = session();
  const ActingEffect here{&effect(), side(), nominal_values(effect())};
  const ActingEffect image = mirrored(here);
  const std::vector<double> a =
      found(machine_with({applied(*here.effect, here.side, here.values)}), visits);
  for (Visit& visit : visits) visit.position.x_mm = -visit.position.x_mm;
  const std::vector<double> b =
      found(machine_with({applied(*image.effect, image.side, image.values)}), visits);
  ASSERT_EQ(a.size(), b.size());
  // The equilibrium is solved to 1e-10 mm on the bed; its two chains are eliminated in the same
  // order in both cases.
  constexpr double kSolvedMm = 1e-9;
  for (std::size_t i = 0; i < a.size(); i += 4) {
    EXPECT_NEAR(a[i], -b[i], kSolvedMm);
    EXPECT_NEAR(a[i + 1], b[i + 1], kSolvedMm);
    EXPECT_NEAR(a[i + 2], b[i + 3], kSolvedMm);
    EXPECT_NEAR(a[i + 3], b[i + 2], kSolvedMm);
  }
}

// The change by two effects together is the sum of the changes by each, up to second order: with
// half the sizes a quarter of that part remains.
TEST_P(EffectContract, AddsToOthersToFirstOrder) {
  const std::vector<double> plain = seen_with({});
  for (const Case& other : partners_of(effect())) {
    SCOPED_TRACE(::testing::PrintToString(other));
    const auto at_share = [&](double share) {
      const AppliedEffect a = with(scaled(effect(), nominal_values(effect()), share));
      const AppliedEffect b = applied(*other.effect, other.side,
                                      scaled(*other.effect, nominal_values(*other.effect), share));
      const std::vector<double> alone_a = seen_with({a});
      const std::vector<double> alone_b = seen_with({b});
      const std::vector<double> together = seen_with({a, b});
      std::vector<double> sum = plain;
      for (std::size_t i = 0; i < plain.size(); ++i) sum[i] = alone_a[i] + (alone_b[i] - plain[i]);
      return largest_difference(together, sum);
    };
    const double full = at_share(0.25);
    const double half = at_share(0.125);
    // Rounding of numbers of 3000 mm through a solver that stops at 1e-10 mm.
    constexpr double kRoundingMm = 1e-9;
    // A kink's knee may lie between the two states of a point, which leaves a first-order part of
    // the other effect's change of angle; 0.35 is between the quarter of a smooth pair and the half
    // of an additive failure.
    EXPECT_LE(half, 0.35 * full + kRoundingMm);
    const double alone = largest_difference(seen_with({with(nominal_values(effect()))}), plain);
    EXPECT_LE(full, 0.05 * std::max(alone, 1.0)) << "the mixed part is no small part of the whole";
  }
}

TEST_P(EffectContract, DoesNotDependOnTheOrderInTheFile) {
  const AppliedEffect a = with(nominal_values(effect()));
  for (const Case& other : partners_of(effect())) {
    const AppliedEffect b = applied(*other.effect, other.side, nominal_values(*other.effect));
    EXPECT_EQ(seen_with({a, b}), seen_with({b, a})) << ::testing::PrintToString(other);
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectContract, ::testing::ValuesIn(cases_of(catalogue())),
                         case_name);
INSTANTIATE_TEST_SUITE_P(Declared, EffectContract,
                         ::testing::ValuesIn(cases_of(declared_examples())), case_name);

}  // namespace
}  // namespace chaintrue::model::effects
