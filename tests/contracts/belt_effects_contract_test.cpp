// SPDX-License-Identifier: GPL-3.0-or-later
// Equations of the effects of four belts, by hand; their laws are those of every mechanism's effects
// (mechanism_effects_contract_test.cpp).
#include <gtest/gtest.h>

#include <cmath>

#include "model/belts/belt_readings.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::model::belts {
namespace {

using effects::Effect;
using effects::EffectSide;
using testing_support::stated;

double read(const BeltMachine& machine, const std::vector<effects::ActingEffect>& effects,
            const BeltVisit& visit, FramePoint place) {
  return read_belt(machine, effects, visit, place).value().value;
}

TEST(BeltEffects, StandAtOneStationAndAreFoundByTheirIds) {
  for (const Effect* effect : belt_effects()) {
    EXPECT_NE(effect->alter_anchor != nullptr, effect->add != nullptr) << effect->id;
    EXPECT_EQ(effect->alter_anchor != nullptr, effect->station == effects::Station::machine);
    EXPECT_EQ(effects::find_effect(belt_effects(), effect->id), effect);
  }
}

TEST(BeltEffects, EachEquationAgreesWithHandCalculation) {
  const BeltMachine machine = stated(BeltLengths::belt);
  const FramePoint place{900.0, 600.0};
  const double bl = reading_at(machine, Belt::bl, place)->length_mm;
  const auto added = [&](const Effect& effect, EffectSide side, std::vector<double> values,
                         BeltVisit visit) {
    return read(machine, {{&effect, side, std::move(values)}}, visit, place) -
           reading_at(machine, visit.belt, place)->length_mm;
  };
  const BeltVisit pulled{Belt::bl, kLowerBeltsPulled, 12};
  const BeltVisit held{Belt::bl, {}, 12};
  const BeltVisit harder{Belt::bl, kLowerBeltsPulled, 12, 1.6};
  // Rounding of 3 m.
  EXPECT_NEAR(added(belt_stretch, EffectSide::none, {0.004}, pulled), -0.004 * bl, 1e-11);
  EXPECT_EQ(added(belt_stretch, EffectSide::none, {0.004}, held), 0.0);
  EXPECT_NEAR(added(anchor_flex, EffectSide::none, {1.5}, pulled), -1.5, 1e-11);
  EXPECT_EQ(added(anchor_flex, EffectSide::none, {1.5}, held), 0.0);
  // What gives with the pull scales with it, what the encoder counts does not.
  EXPECT_NEAR(added(belt_stretch, EffectSide::none, {0.004}, harder), -0.0064 * bl, 1e-11);
  EXPECT_NEAR(added(anchor_flex, EffectSide::none, {1.5}, harder), -2.4, 1e-11);
  EXPECT_EQ(added(belt_scale, EffectSide::bl, {0.01}, harder),
            added(belt_scale, EffectSide::bl, {0.01}, pulled));
  EXPECT_NEAR(added(belt_scale, EffectSide::bl, {0.01}, held), bl / 1.01 - bl, 1e-11);
  EXPECT_NEAR(added(belt_zero, EffectSide::all, {-153.4}, held), -153.4, 1e-11);
  EXPECT_NEAR(added(tooth_skip, EffectSide::bl, {22.0, 12.0}, held), 43.975, 1e-11);
  EXPECT_EQ(added(tooth_skip, EffectSide::bl, {22.0, 13.0}, held), 0.0);
  EXPECT_NEAR(added(zero_shift, EffectSide::bl, {-3.7, 12.0}, held), -3.7, 1e-11);
  EXPECT_EQ(added(zero_shift, EffectSide::bl, {-3.7, 13.0}, held), 0.0);
  EXPECT_NEAR(added(drift, EffectSide::all, {0.05}, held), 0.6, 1e-11);
  const double level = std::hypot(900.0, 600.0) - 153.4;
  EXPECT_NEAR(added(anchor_height, EffectSide::bl, {40.0}, held), std::hypot(level, 74.0) - bl,
              1e-11);
  const double moved = std::hypot(900.0 - 3.0, 600.0) - 153.4;
  EXPECT_NEAR(added(anchor_moved, EffectSide::bl, {3.0, 0.0, 12.0}, held),
              std::hypot(moved, 34.0) - bl, 1e-11);
  EXPECT_EQ(added(anchor_moved, EffectSide::bl, {3.0, 0.0, 13.0}, held), 0.0);
}

TEST(BeltEffects, HoldingBeltsStretchByTheirTension) {
  const BeltMachine machine = stated(BeltLengths::belt);
  const FramePoint place{900.0, 600.0};
  const auto tension = tensions_of(machine, kLowerBeltsPulled, 1.6, place);
  for (const Belt belt : kBelts) {
    const BeltVisit visit{belt, kLowerBeltsPulled, 12, 1.6};
    const double plain = reading_at(machine, belt, place)->length_mm;
    // Rounding of 3 m.
    EXPECT_NEAR(read(machine, {{&belt_stretch, EffectSide::none, {0.002}}}, visit, place),
                plain - 0.002 * tension[belt].value * plain, 1e-11);
    EXPECT_NEAR(read(machine, {{&anchor_flex, EffectSide::none, {1.5}}}, visit, place),
                plain - 1.5 * tension[belt].value, 1e-11);
  }
}

TEST(BeltEffects, ALevelPrintRemovesTheConfiguredHeights) {
  const BeltMachine machine = stated();
  const FramePoint place{900.0, 600.0};
  const BeltVisit visit{Belt::bl, kLowerBeltsPulled, 0};
  const double count = std::hypot(std::hypot(900.0, 600.0) - 153.4, 34.0 + 40.0);
  // Rounding of 1 m.
  EXPECT_NEAR(read(machine, {{&anchor_height, EffectSide::bl, {40.0}}}, visit, place),
              std::sqrt(count * count - 34.0 * 34.0) + 153.4, 1e-11);
}

TEST(BeltEffects, ReportImpossibleValues) {
  EXPECT_TRUE(
      effects::problems_in(belt_effects(), {{"belt_zero", "all", {{"offset_mm", 2.0}}}}).empty());
  const auto problems = effects::problems_in(
      belt_effects(), {{"belt_shrink", "", {}},
                       {"belt_scale", "left", {{"scale", 0.2}}},
                       {"tooth_skip", "tl", {{"teeth", 1.5}, {"links", 1.0}}}});
  ASSERT_EQ(problems.size(), 5U);
  EXPECT_EQ(problems[0].parameter, "/0/effect");
  EXPECT_EQ(problems[1].parameter, "/1/side");
  EXPECT_EQ(problems[2].parameter, "/1/parameters/scale");
  EXPECT_EQ(problems[2].value, "0.2");
  EXPECT_EQ(problems[3].parameter, "/2/parameters/teeth");
  EXPECT_EQ(problems[3].value, "1.5");
  EXPECT_EQ(problems[4].parameter, "/2/parameters/links");
  EXPECT_THROW((void)effects::resolve(belt_effects(), {{"belt_shrink", "", {}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model::belts
