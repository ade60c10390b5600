// SPDX-License-Identifier: GPL-3.0-or-later
// The hidden belts checked for consistency and against the product: forces in balance, slack belts
// without tension, and stiff belts with the lengths of the product's kinematics.
#include "generator/hidden/belts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::generator {
namespace {

BeltFrame frame() {
  BeltFrame frame;
  frame.anchors = {
      {{-31.5, 2071.2, 100.0}, {2931.8, 2058.4, 56.0}, {0.0, 0.0, 34.0}, {2944.9, 0.0, 78.0}}};
  return frame;
}

model::BeltMachine machine_of(const BeltFrame& frame) {
  model::BeltMachine machine;
  machine.anchors_known = true;
  machine.lengths = model::BeltLengths::belt;
  for (const model::Belt belt : model::kBelts) {
    const auto& a = frame.anchors[static_cast<std::size_t>(belt)];
    machine.anchors[belt] = {a[0], a[1], a[2]};
  }
  return machine;
}

std::vector<std::array<double, 2>> places() {
  std::vector<std::array<double, 2>> all;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      all.push_back({750.0 + 180.0 * column, 600.0 + 100.0 * row});
    }
  }
  return all;
}

TEST(HiddenBelts, StiffBeltsMatchTheKinematics) {
  BeltFrame stiff = frame();
  stiff.stiffness_n = 1e8;
  for (const auto& [x, y] : places()) {
    FourLengths held{};
    const auto lengths = model::lengths_at(machine_of(stiff), {x, y}).value();
    held[0] = lengths.tl;
    held[1] = lengths.tr;
    const SledAtRest rest = rest_on_belts(stiff, {false, false, true, true}, held,
                                          {0.0, 0.0, 150.0, 150.0}, x, y - 1.0);
    // 600 N at most over 1e8 N, of 3 m: 0.02 mm of belt, and twice that of place.
    EXPECT_NEAR(rest.x_mm, x, 0.05);
    EXPECT_NEAR(rest.y_mm, y, 0.05);
    EXPECT_NEAR(rest.length_mm[2], lengths.bl, 0.05);
    EXPECT_NEAR(rest.length_mm[3], lengths.br, 0.05);
  }
}

TEST(HiddenBelts, ForcesBalanceAndSlackBeltsCarryNothing) {
  const BeltFrame elastic = frame();
  FourLengths held{};
  held[0] = 1500.0;
  held[1] = 1900.0;
  const SledAtRest rest = rest_on_belts(elastic, {false, false, true, true}, held,
                                        {0.0, 0.0, 150.0, 150.0}, 1300.0, 1000.0);
  double fx = 0.0;
  double fy = -elastic.weight_n;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& a = elastic.anchors[i];
    const double span = std::hypot(a[0] - rest.x_mm, a[1] - rest.y_mm);
    const double level = span - elastic.reach_mm;
    const double share = level / std::hypot(level, a[2]);
    fx += rest.tension_n[i] * share * (a[0] - rest.x_mm) / span;
    fy += rest.tension_n[i] * share * (a[1] - rest.y_mm) / span;
  }
  // The solver's convergence tolerance, for 100 N and more.
  EXPECT_NEAR(fx, 0.0, 1e-4);
  EXPECT_NEAR(fy, 0.0, 1e-4);
  EXPECT_EQ(rest.tension_n[2], 150.0);
  // A lower belt that holds with 100 mm too much is slack.
  FourLengths loose = rest.length_mm;
  loose[2] += 100.0;
  const SledAtRest slack = rest_on_belts(elastic, {false, false, false, true}, loose,
                                         {0.0, 0.0, 0.0, 150.0}, rest.x_mm, rest.y_mm);
  EXPECT_EQ(slack.tension_n[2], 0.0);
}

}  // namespace
}  // namespace chaintrue::generator
