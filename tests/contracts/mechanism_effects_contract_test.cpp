// SPDX-License-Identifier: GPL-3.0-or-later
/// Laws of the effects of every mechanism.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/contracts/every_mechanism.hpp"

namespace chaintrue::model::contract {
namespace {

class MechanismEffectsContract : public EveryMechanism {
 protected:
  /// The largest change of a length, over all places and visits.
  double most_added(const Mechanism& mechanism, const AppliedEffect& effect) const {
    double most = 0.0;
    for (const MechanismVisit& visit : visits(mechanism)) {
      for (const ToolPosition& q : positions(mechanism)) {
        const Eigen::VectorXd added = added_by(mechanism, effect, q, visit).value();
        EXPECT_TRUE(added.allFinite());
        most = std::max(most, added.cwiseAbs().maxCoeff());
      }
    }
    return most;
  }
};

INSTANTIATE_TEST_SUITE_P(Every, MechanismEffectsContract, testing::ValuesIn(every_mechanism()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(MechanismEffectsContract, AnEffectAtNullAddsExactlyNothing) {
  const MechanismPtr mechanism = GetParam().make();
  for (const AppliedEffect& effect : null_effects(*mechanism))
    EXPECT_EQ(most_added(*mechanism, effect), 0.0) << effect.effect << ":" << effect.side;
}

TEST_P(MechanismEffectsContract, AnEffectOfItsUsualSizeIsThere) {
  const MechanismPtr mechanism = GetParam().make();
  for (const AppliedEffect& effect : nominal_effects(*mechanism)) {
    SCOPED_TRACE(effect.effect + ":" + effect.side);
    EXPECT_GT(most_added(*mechanism, effect), 1e-3);  // a micrometre: any effect at all
  }
}

TEST_P(MechanismEffectsContract, EffectsAreDescribed) {
  const MechanismPtr mechanism = GetParam().make();
  std::set<std::string_view> ids;
  for (const effects::Effect* effect : mechanism->effects()) {
    SCOPED_TRACE(std::string(effect->id));
    EXPECT_TRUE(ids.insert(effect->id).second);
    for (const std::string_view words :
         {effect->id, effect->cause, effect->signature, effect->equation, effect->source,
          effect->not_modelled, effect->typical, effect->remedy}) {
      EXPECT_FALSE(words.empty());
      EXPECT_EQ(words.find('|'), std::string_view::npos)
          << "breaks a table of documents: " << words;
    }
    EXPECT_FALSE(effect->sides.empty());
    ASSERT_FALSE(effect->parameters.empty());
    EXPECT_EQ(effect->parameters.front().role, effects::ParameterRole::size);
    for (const effects::EffectParameter& p : effect->parameters) {
      SCOPED_TRACE(std::string(p.name));
      EXPECT_LT(p.lower, p.upper);
      EXPECT_LE(p.lower, p.null);
      EXPECT_LE(p.null, p.upper);
      EXPECT_LE(p.lower, p.nominal);
      EXPECT_LE(p.nominal, p.upper);
      EXPECT_GT(p.prior_sigma, 0.0);
      EXPECT_FALSE(p.meaning.empty() || p.symbol.empty());
      EXPECT_EQ(p.nominal != p.null, p.role == effects::ParameterRole::size);
      if (p.integer) {
        EXPECT_EQ(p.nominal, std::round(p.nominal));
      }
    }
  }
}

TEST_P(MechanismEffectsContract, EffectsAreFiniteAtTheirBounds) {
  const MechanismPtr mechanism = GetParam().make();
  const MechanismExtent e = mechanism->extent();
  const ToolPosition aside{e.x_min_mm + 0.3 * (e.x_max_mm - e.x_min_mm),
                           e.y_min_mm + 0.3 * (e.y_max_mm - e.y_min_mm)};
  for (const effects::Effect* effect : mechanism->effects()) {
    for (unsigned corner = 0; corner < (1U << effect->parameters.size()); ++corner) {
      std::vector<double> values;
      for (const effects::EffectParameter& p : effect->parameters)
        values.push_back((corner >> values.size() & 1U) != 0 ? p.upper : p.lower);
      for (const effects::EffectSide side : effect->sides) {
        const AppliedEffect applied = effects::applied(*effect, side, values);
        SCOPED_TRACE(applied.effect + ":" + applied.side + testing::PrintToString(values));
        if (!mechanism->problems_of_effects({applied}).empty()) continue;
        const MechanismPtr with = mechanism->with_effects({applied});
        for (const MechanismVisit& visit : visits(*mechanism)) {
          for (const ToolPosition& q : {e.centre(), aside}) {
            const auto at = with->predict(q, visit);
            // A pen held by more than its gondola's weight has no equilibrium.
            const bool is_held = !at && effect->id == "pen_friction";
            EXPECT_TRUE(is_held || (at && at->lengths_mm.allFinite()));
          }
        }
      }
    }
  }
}

TEST_P(MechanismEffectsContract, AnEffectOfOneSideChangesOnlyItsLength) {
  const MechanismPtr mechanism = GetParam().make();
  const auto lengths = mechanism->lengths();
  for (const AppliedEffect& effect : nominal_effects(*mechanism)) {
    const auto own = std::find(lengths.begin(), lengths.end(), effect.side);
    if (own == lengths.end()) continue;
    // A cord that stretches or weighs more tilts the gondola, which changes the other cord too.
    if (effect.effect.starts_with("cord_")) continue;
    SCOPED_TRACE(effect.effect + ":" + effect.side);
    for (const MechanismVisit& visit : visits(*mechanism)) {
      for (const ToolPosition& q : positions(*mechanism)) {
        auto added = *added_by(*mechanism, effect, q, visit);
        added[own - lengths.begin()] = 0.0;
        EXPECT_LT(added.cwiseAbs().maxCoeff(), 1e-11);  // rounding of 3 m
      }
    }
  }
}

TEST(ChainMechanismTest, VisitsReadAsASessionDoes) {
  for (const effects::Effect* effect : effects::catalogue()) {
    for (const effects::EffectSide side : effect->sides) {
      Machine machine = leaning();
      machine.effects = {{"chain_pitch_error", "left", {{"elongation", 0.001}}},
                         effects::applied(*effect, side, effects::nominal_values(*effect))};
      if (!effects::problems_of_effects(machine).empty()) continue;
      const ReadingModel mechanism(machine);
      // The right chain is taken in on the way to the second position, the left one paid out.
      const std::vector<Visit> visits = {{{-500.0, 0.0}, 11}, {{500.0, -40.0}, 12}};
      const auto session = readings(ReadingModel(machine), visits);
      ASSERT_TRUE(session);
      const auto at = mechanism.predict({500.0, -40.0}, {12, {1.0, -1.0}, {}});
      ASSERT_TRUE(at);
      // Rounding of sums of 3 m in another order.
      EXPECT_NEAR(at->lengths_mm[0], (*session)[1].left_mm, 1e-11) << effect->id;
      EXPECT_NEAR(at->lengths_mm[1], (*session)[1].right_mm, 1e-11) << effect->id;
    }
  }
}

}  // namespace
}  // namespace chaintrue::model::contract
