// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the four-belt kinematics, for every kind of printed length: inverse and forward are
// consistent, and the lengths equal those of the published firmware.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "model/belts/belt_kinematics.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::model {
namespace {

using testing_support::stated;

struct BeltController {
  std::string name;
  BeltMachine machine;
};

void PrintTo(const BeltController& kind, std::ostream* out) { *out << kind.name; }

BeltMachine skew() {
  BeltMachine machine = stated();
  machine.anchors = {
      {-23.0, 2150.0, 110.0}, {3471.0, 2837.0, 40.0}, {0.0, 0.0, -12.0}, {3704.0, 0.0, 90.0}};
  machine.surface_mm = 31.0;
  machine.arm_mm = 140.0;
  return machine;
}

std::vector<BeltController> belt_controllers() {
  std::vector<BeltController> all;
  for (const BeltLengths lengths :
       {BeltLengths::belt, BeltLengths::belt_and_arm, BeltLengths::span}) {
    for (const auto& [frame, machine] : {std::pair("plain", stated()), std::pair("skew", skew())}) {
      BeltController kind{std::string(name(lengths)) + "_" + frame, machine};
      kind.machine.lengths = lengths;
      all.push_back(kind);
    }
  }
  return all;
}

class BeltKinematicsLaws : public testing::TestWithParam<BeltController> {
 protected:
  const BeltMachine& machine() const { return GetParam().machine; }
  /// Positions over the frame, 250 mm within its anchors so that none is inside an arm.
  std::vector<FramePoint> places() const {
    constexpr unsigned kSeed = 20260918;
    RecordProperty("seed", kSeed);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> x(250.0, machine().anchors.br.x_mm - 250.0);
    std::uniform_real_distribution<double> y(250.0, machine().anchors.tl.y_mm - 250.0);
    std::vector<FramePoint> places;
    for (int i = 0; i < 200; ++i) places.push_back({x(random), y(random)});
    return places;
  }
};

INSTANTIATE_TEST_SUITE_P(Every, BeltKinematicsLaws, testing::ValuesIn(belt_controllers()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(BeltKinematicsLaws, TheUpperTwoLengthsOfAPlaceLeadBackToIt) {
  for (const FramePoint place : places()) {
    const auto lengths = lengths_at(machine(), place);
    ASSERT_TRUE(lengths) << lengths.error().sentence();
    const auto back = place_of_upper(machine(), lengths->tl, lengths->tr);
    ASSERT_TRUE(back) << back.error().sentence();
    // Rounding of 3 m of belt, 4e-13 mm, over the flattest angle of the belts here, 5 degrees.
    EXPECT_NEAR(back->x_mm, place.x_mm, 1e-9);
    EXPECT_NEAR(back->y_mm, place.y_mm, 1e-9);
  }
}

TEST_P(BeltKinematicsLaws, TheSpanOfALengthIsTheDistanceFromTheAnchor) {
  for (const FramePoint place : places()) {
    for (const Belt belt : kBelts) {
      const Anchor& anchor = machine().anchors[belt];
      const auto reading = reading_at(machine(), belt, place);
      ASSERT_TRUE(reading);
      const auto span = span_of(machine(), belt, reading->length_mm);
      ASSERT_TRUE(span);
      // Rounding of 4 m.
      EXPECT_NEAR(*span, std::hypot(place.x_mm - anchor.x_mm, place.y_mm - anchor.y_mm), 1e-10);
    }
  }
}

// With the firmware's names: a and b to the corner, c down to the belt's end, arm and extension
// subtracted from the horizontal length; before October 2024 from the slanting length.
TEST(BeltKinematics, LengthsMatchThePublishedFirmware) {
  BeltMachine machine = stated();
  machine.surface_mm = 18.0;
  const FramePoint place{1000.0, 700.0};
  const double a = 2924.3 - 1000.0;
  const double b = 2066.5 - 700.0;
  const double c = 0.0 - (56.0 + 18.0);
  machine.lengths = BeltLengths::belt;
  const double level = std::sqrt(a * a + b * b) - (30.0 + 123.4);
  // Rounding of 2 m.
  EXPECT_NEAR(lengths_at(machine, place)->tr, std::sqrt(level * level + c * c), 1e-11);
  machine.lengths = BeltLengths::belt_and_arm;
  const double old_length = std::sqrt(a * a + b * b + c * c) - (30.0 + 123.4);
  EXPECT_NEAR(lengths_at(machine, place)->tr, old_length + (30.0 + 123.4), 1e-11);
  machine.lengths = BeltLengths::span;
  EXPECT_NEAR(lengths_at(machine, place)->tr, std::sqrt(a * a + b * b), 1e-11);
}

TEST(BeltKinematics, CommandsCountFromWhereTheDiagonalsCross) {
  BeltMachine machine = skew();
  const FramePoint centre = centre_of(machine);
  const auto aside = [&](FramePoint from, FramePoint to) {
    return (to.x_mm - from.x_mm) * (centre.y_mm - from.y_mm) -
           (to.y_mm - from.y_mm) * (centre.x_mm - from.x_mm);
  };
  // Rounding of 4 m squared.
  EXPECT_NEAR(aside({0.0, 0.0}, {3471.0, 2837.0}), 0.0, 1e-8);
  EXPECT_NEAR(aside({3704.0, 0.0}, {-23.0, 2150.0}), 0.0, 1e-8);
  machine.scale_x = 1.002;
  machine.scale_y = 0.999;
  const FramePoint at = to_frame(machine, {500.0, -300.0});
  // Rounding of 2 m.
  EXPECT_NEAR(at.x_mm - centre.x_mm, 501.0, 1e-11);
  EXPECT_NEAR(at.y_mm - centre.y_mm, -299.7, 1e-11);
}

TEST(BeltKinematics, NamesImpossiblePlaces) {
  BeltMachine machine = stated();
  machine.lengths = BeltLengths::belt;
  EXPECT_EQ(lengths_at(machine, {-27.6, 2000.0}).error(), BeltReason::inside_the_arm);
  EXPECT_EQ(lengths_at(machine, {-27.6, 2064.9}).error(), BeltReason::inside_the_arm);
  EXPECT_EQ(span_of(machine, Belt::tl, 99.0).error(), BeltReason::shorter_than_height);
  EXPECT_EQ(place_of_upper(machine, 900.0, 900.0).error(), BeltReason::circles_do_not_meet);
  machine.anchors_known = false;
  EXPECT_THROW((void)lengths_at(machine, {1000.0, 1000.0}), std::logic_error);
  EXPECT_THROW((void)centre_of(machine), std::logic_error);
}

TEST(BeltMachine, EverySlipIsReported) {
  EXPECT_TRUE(problems_of(BeltMachine{}).empty());
  EXPECT_TRUE(problems_of(stated()).empty());
  EXPECT_TRUE(problems_of(skew()).empty());
  BeltMachine inches = stated();
  for (const Belt belt : kBelts) {
    inches.anchors[belt].x_mm /= 25.4;
    inches.anchors[belt].y_mm /= 25.4;
  }
  EXPECT_EQ(problems_of(inches).size(), 2U);
  BeltMachine swapped = stated();
  std::swap(swapped.anchors.tl, swapped.anchors.tr);
  ASSERT_EQ(problems_of(swapped).size(), 1U);
  EXPECT_EQ(problems_of(swapped).front().parameter, "/anchors");
  BeltMachine wrong = stated();
  wrong.anchors.bl.x_mm = 3.0;
  wrong.arm_mm = -1.0;
  wrong.scale_y = 0.0;
  ASSERT_EQ(problems_of(wrong).size(), 3U);
  EXPECT_EQ(problems_of(wrong)[0].parameter, "/anchors/bl/x_mm");
  EXPECT_EQ(problems_of(wrong)[1].parameter, "/arm_mm");
  EXPECT_EQ(problems_of(wrong)[2].parameter, "/scale_y");
}

}  // namespace
}  // namespace chaintrue::model
