// SPDX-License-Identifier: GPL-3.0-or-later
// Tensions of four belts: they balance, they only pull, and their derivatives are differences.
#include "model/belts/belt_statics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/belt_frame.hpp"

namespace chaintrue::model::belts {
namespace {

BeltMachine frame(Orientation orientation) {
  BeltMachine machine = testing_support::stated();
  machine.orientation = orientation;
  return machine;
}

constexpr PerBelt<bool> kLeftPulled{true, false, true, false};
constexpr PerBelt<bool> kOnePulled{false, false, false, true};
constexpr PerBelt<bool> kOneHolds{false, true, true, true};

std::vector<FramePoint> places() {
  std::vector<FramePoint> all;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column)
      all.push_back({700.0 + 380.0 * column, 450.0 + 270.0 * row});
  }
  return all;
}

PerBelt<double> values_of(const PerBelt<AnchorNumber>& tension) {
  return {tension.tl.value, tension.tr.value, tension.bl.value, tension.br.value};
}

PerBelt<double> tension_values(const BeltMachine& machine, const PerBelt<bool>& pulled, double pull,
                               FramePoint place) {
  return values_of(tensions_of(machine, pulled, pull, place));
}

/// Sum of the level forces of belts and weight.
Eigen::Vector2d force(const BeltMachine& machine, const PerBelt<double>& tension,
                      FramePoint place) {
  Eigen::Vector2d sum(0.0, machine.orientation == Orientation::upright ? -kWeightOverPull : 0.0);
  for (const Belt belt : kBelts) {
    const Anchor& a = machine.anchors[belt];
    const Eigen::Vector2d way(a.x_mm - place.x_mm, a.y_mm - place.y_mm);
    const double level = way.norm() - reach_mm(machine);
    sum += tension[belt] * level / std::hypot(level, height_mm(machine, belt)) * way.normalized();
  }
  return sum;
}

bool all_taut(const PerBelt<double>& tension) {
  return tension.tl > 0.0 && tension.tr > 0.0 && tension.bl > 0.0 && tension.br > 0.0;
}

TEST(BeltTensions, TwoHoldingBeltsBalanceTheTwoPulledAndTheWeight) {
  int taut = 0;
  for (const Orientation orientation : {Orientation::upright, Orientation::flat}) {
    const BeltMachine machine = frame(orientation);
    for (const PerBelt<bool>& pulled : {kLowerBeltsPulled, kLeftPulled}) {
      for (const FramePoint place : places()) {
        const PerBelt<double> tension = tension_values(machine, pulled, 1.6, place);
        for (const Belt belt : kBelts) {
          EXPECT_GE(tension[belt], 0.0);
          if (pulled[belt]) {
            EXPECT_EQ(tension[belt], 1.6);
          }
        }
        if (!all_taut(tension)) continue;
        ++taut;
        // Rounding of forces of some pulls.
        EXPECT_LT(force(machine, tension, place).norm(), 1e-12) << place.x_mm << ' ' << place.y_mm;
      }
    }
  }
  // All but some near the edges, where the sled would swing until a belt is slack.
  EXPECT_GE(taut, 80);
}

TEST(BeltTensions, AreAllNearThePullInTheMiddleOfAFlatFrame) {
  const PerBelt<double> tension =
      tension_values(frame(Orientation::flat), kLowerBeltsPulled, 1.0, {1462.0, 1033.0});
  // The belts' heights differ, 3 % of their length.
  EXPECT_NEAR(tension.tl, 1.0, 0.01);
  EXPECT_NEAR(tension.tr, 1.0, 0.01);
}

TEST(BeltTensions, AreUnknownWithoutAPull) {
  const auto none =
      tensions_of(frame(Orientation::upright), PerBelt<bool>{}, 1.0, FramePoint{1462.0, 1033.0});
  for (const Belt belt : kBelts) {
    EXPECT_EQ(none[belt].value, 0.0);
    EXPECT_EQ(by_anchor(none[belt], Belt::tl).norm(), 0.0);
  }
  EXPECT_THROW((void)tension_values(BeltMachine{}, kLowerBeltsPulled, 1.0, {}), std::logic_error);
}

TEST(BeltTensions, OneHoldingBeltCarriesTheForceAlongIt) {
  const BeltMachine machine = frame(Orientation::flat);
  const FramePoint place{1500.0, 1000.0};
  const PerBelt<double> one = tension_values(machine, kOneHolds, 1.0, place);
  EXPECT_GT(one.tl, 0.0);
  const Anchor& a = machine.anchors.tl;
  const Eigen::Vector2d along(a.x_mm - place.x_mm, a.y_mm - place.y_mm);
  // The remaining force is across that belt: rounding.
  EXPECT_NEAR(force(machine, one, place).dot(along.normalized()), 0.0, 1e-12);
  const PerBelt<double> three = tension_values(machine, kOnePulled, 1.0, place);
  for (const Belt belt : kBelts) EXPECT_LE(three[belt], 1.0);
}

TEST(BeltTensions, AreLimitedBetweenTwoHoldingAnchors) {
  const BeltMachine machine = frame(Orientation::upright);
  for (const double y : {2064.0, 2065.7, 2066.0, 2080.0}) {
    const PerBelt<double> tension = tension_values(machine, kLowerBeltsPulled, 1.0, {1500.0, y});
    EXPECT_LE(tension.tl, kMostTension);
    EXPECT_LE(tension.tr, kMostTension);
  }
}

TEST(BeltTensions, DerivativesAreDifferences) {
  constexpr double kStepMm = 0.01;
  for (const Orientation orientation : {Orientation::upright, Orientation::flat}) {
    const BeltMachine machine = frame(orientation);
    for (const PerBelt<bool>& pulled : {kLowerBeltsPulled, kLeftPulled, kOnePulled}) {
      for (const FramePoint place : places()) {
        const auto at = tensions_of(machine, pulled, 1.3, place);
        if (!all_taut(values_of(at))) continue;
        for (const Belt anchor : kBelts) {
          for (const bool by_x : {true, false}) {
            const auto moved = [&](double step) {
              BeltMachine other = machine;
              (by_x ? other.anchors[anchor].x_mm : other.anchors[anchor].y_mm) += step;
              return tension_values(other, pulled, 1.3, place);
            };
            const PerBelt<double> more = moved(kStepMm), less = moved(-kStepMm);
            for (const Belt belt : kBelts) {
              // A tension changes by 1e-3 a mm; rounding of differences, 1e-16 over the step.
              EXPECT_NEAR(by_anchor(at[belt], anchor)[by_x ? 0 : 1],
                          (more[belt] - less[belt]) / (2.0 * kStepMm), 1e-9);
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace chaintrue::model::belts
