// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Two independent implementations of every effect of the catalogue, alone and together, compared
/// over whole sessions.
#include "generator/hidden/effects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "generator/hidden/random.hpp"
#include "generator/hidden/session.hpp"
#include "generator/hidden/strength.hpp"
#include "grid/synthetic/strength.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::generator {
namespace {

/// The hidden machine with a round drum, as in the product.
TrueMachine drum() {
  TrueMachine m;
  m.wheel = WheelShape::round;
  m.pieces_per_link = 2;
  return m;
}

std::vector<Visit> session(std::uint64_t seed, int points) {
  Dice dice(seed, "session");
  std::vector<Visit> visits;
  for (const PlannedVisit& p : plan_visits(layout_of(points), Order::random, dice)) {
    visits.push_back({{p.place.x + dice.uniform(-8.0, 8.0), p.place.y + dice.uniform(-8.0, 8.0)},
                      static_cast<int>(visits.size())});
  }
  return visits;
}

Hidden usual(const CauseCard& c, Where where) {
  Hidden h{c.cause, where, c.usual, 0.0};
  if (c.place == Place::phase) h.place = 0.7;
  if (c.place == Place::angle) h.place = 0.9;
  if (c.place == Place::visit) h.place = 12.0;
  return h;
}

model::AppliedEffect applied(const Hidden& h) {
  const CauseCard& c = card(h.cause);
  model::AppliedEffect effect{std::string(c.id), std::string(word(h.where)), {}};
  effect.parameters[std::string(c.size_name)] = h.size;
  if (c.place != Place::none) effect.parameters[std::string(c.place_name)] = h.place;
  return effect;
}

std::vector<model::Visit> visits_of_product(const std::vector<Visit>& visits) {
  std::vector<model::Visit> theirs;
  for (const Visit& v : visits) theirs.push_back({{v.place.x, v.place.y}, v.number});
  return theirs;
}

// The product's readings of the same visits.
std::vector<model::ChainLengths> product(const std::vector<Visit>& visits,
                                         const std::vector<Hidden>& effects, bool over_top) {
  model::Machine machine;
  machine.feed = over_top ? model::Feed::over_top : model::Feed::off_bottom;
  for (const Hidden& h : effects) machine.effects.push_back(applied(h));
  const auto read = model::readings(model::ReadingModel(machine), visits_of_product(visits));
  EXPECT_TRUE(read.has_value());
  return read.value_or(std::vector<model::ChainLengths>(visits.size()));
}

void expect_same(const std::vector<Visit>& visits, const std::vector<Hidden>& effects,
                 bool over_top) {
  TrueMachine m = drum();
  m.over_top = over_top;
  m = altered(m, effects);
  const auto at_rest = rests(m, visits);
  ASSERT_TRUE(at_rest);
  const auto ours = readings(m, effects, visits, *at_rest);
  const auto theirs = product(visits, effects, over_top);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    // Half links against an even cable: a quarter of 1e-4 mm.
    EXPECT_NEAR(ours[i][0], theirs[i].left_mm, 5e-5) << "visit " << i;
    EXPECT_NEAR(ours[i][1], theirs[i].right_mm, 5e-5) << "visit " << i;
  }
}

TEST(Cards, AreTheCatalogueOfTheProduct) {
  // The hidden machines hang on a ring.
  const auto catalogue = model::effects::effects_of(model::Machine{});
  ASSERT_EQ(catalogue.size(), kCauses);
  for (std::size_t i = 0; i < kCauses; ++i) {
    const auto& theirs = *catalogue[i];
    const CauseCard& ours = cards()[i];
    SCOPED_TRACE(std::string(theirs.id));
    EXPECT_EQ(static_cast<std::size_t>(ours.cause), i);
    EXPECT_EQ(ours.id, theirs.id);
    EXPECT_EQ(ours.size_name, theirs.parameters[0].name);
    EXPECT_EQ(ours.lower, theirs.parameters[0].lower);
    EXPECT_EQ(ours.upper, theirs.parameters[0].upper);
    EXPECT_EQ(ours.whole(), theirs.parameters[0].integer);
    EXPECT_EQ(ours.place != Place::none, theirs.parameters.size() > 1);
    if (theirs.parameters.size() > 1) {
      EXPECT_EQ(ours.place_name, theirs.parameters[1].name);
    }
    EXPECT_EQ(ours.needs_order(), theirs.needs == model::effects::DataNeed::order);
    ASSERT_EQ(ours.sides.size(), theirs.sides.size());
    for (std::size_t k = 0; k < ours.sides.size(); ++k) {
      EXPECT_EQ(word(ours.sides[k]), model::effects::name(theirs.sides[k]));
    }
  }
}

TEST(Readings, EveryEffectIsReproducible) {
  const auto visits = session(3, 28);
  for (const CauseCard& c : cards()) {
    for (const Where where : c.sides) {
      for (const bool over_top : {true, false}) {
        SCOPED_TRACE(std::string(c.id) + ":" + std::string(word(where)) +
                     (over_top ? "" : " off bottom"));
        expect_same(visits, {usual(c, where)}, over_top);
      }
    }
  }
}

// The order of additions, the sign of hysteresis and the division at the end matter only in
// combination.
TEST(Readings, EffectsTogetherAreReproducible) {
  const auto visits = session(4, 60);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed, "together");
    std::vector<Hidden> effects;
    for (const CauseCard& c : cards()) {
      if (dice.uniform() < 0.4) continue;
      Hidden h = usual(c, c.sides[dice.below(c.sides.size())]);
      if (c.lower < 0.0) h.size *= dice.sign();
      effects.push_back(h);
    }
    expect_same(visits, effects, seed % 2 == 0);
  }
}

// delta by the hidden side's own differences compared with the product's table of strengths.
TEST(Strength, EqualsDelta) {
  const auto visits = session(5, 28);
  const grid::StatedNoise noise{.length_mm = 0.2, .position_mm = 0.3};
  const grid::synthetic::StrengthTable table(model::Machine{}, visits_of_product(visits), noise);
  const auto yardstick = Yardstick::make(drum(), visits, {}, {});
  ASSERT_TRUE(yardstick);
  for (const CauseCard& c : cards()) {
    for (const Where where : c.sides) {
      SCOPED_TRACE(std::string(c.id) + ":" + std::string(word(where)));
      const auto& effect = *model::effects::find_effect(c.id);
      const auto values = model::effects::nominal_values(effect);
      const Hidden one[] = {{c.cause, where, values[0], values.size() > 1 ? values[1] : 0.0}};
      const auto ours = yardstick->signature(one);
      ASSERT_TRUE(ours);
      const auto side =
          std::ranges::find(effect.sides, word(where), [](auto s) { return name(s); });
      const double delta = table.strength(effect, *side).signal_to_noise;
      // Differences over 1 mm against exact derivatives, and a weight rounded in its fourth digit.
      EXPECT_NEAR(ours->norm(), delta, 1e-3 * delta + 1e-4);
    }
  }
}

}  // namespace
}  // namespace chaintrue::generator
