// SPDX-License-Identifier: GPL-3.0-or-later
// The hidden belts checked for consistency and against the product: forces in balance, slack belts
// without tension, stiff belts with the lengths of the product's kinematics, and anchors that the
// product finds from hidden readings.
#include "generator/hidden/belts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grid/belts/belts_fit.hpp"
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

grid::MeasuredBelts measured(const BeltSession& session) {
  grid::MeasuredBelts belts;
  belts.machine = machine_of(session.frame);
  belts.machine.anchors_known = false;
  for (const FourLengths& read : read_session(session)) {
    belts.points.push_back({{read[0], read[1], read[2], read[3]}});
  }
  return belts;
}

TEST(HiddenBelts, StiffBeltsMatchTheKinematics) {
  BeltFrame stiff = frame();
  stiff.stiffness_n = 1e8;
  for (const auto& [x, y] : places()) {
    FourLengths held{};
    const auto lengths = model::lengths_at(machine_of(stiff), {x, y}).value();
    held[0] = lengths.tl;
    held[1] = lengths.tr;
    const SledAtRest rest = rest_on_belts(
        stiff, {false, false, true, true}, held, {0.0, 0.0, 150.0, 150.0}, x, y - 1.0);
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
  const SledAtRest rest = rest_on_belts(
      elastic, {false, false, true, true}, held, {0.0, 0.0, 150.0, 150.0}, 1300.0, 1000.0);
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
  const SledAtRest slack = rest_on_belts(
      elastic, {false, false, false, true}, loose, {0.0, 0.0, 0.0, 150.0}, rest.x_mm, rest.y_mm);
  EXPECT_EQ(slack.tension_n[2], 0.0);
}

TEST(HiddenBelts, AnchorsAreFoundFromStiffHiddenReadings) {
  constexpr int kSets = 20;
  double square = 0.0;
  for (int seed = 1; seed <= kSets; ++seed) {
    BeltSession session{frame(), places()};
    session.frame.stiffness_n = 1e9;
    session.noise_mm = 0.4;
    session.seed = static_cast<std::uint64_t>(seed);
    const auto fit = grid::fit_belts(measured(session));
    ASSERT_TRUE(fit) << "seed " << seed;
    const double br_x = session.frame.anchors[3][0];
    square += std::pow((fit->coordinates[4].fitted_mm - br_x) / fit->coordinates[4].sigma_mm, 2);
  }
  // One unknown for each set: within four sigmas of the mean.
  EXPECT_NEAR(square / kSets, 1.0, 4.0 * std::sqrt(2.0 / kSets)) << "seeds 1 to " << kSets;
}

TEST(HiddenBelts, ElasticBeltsLeaveResidualsLikeRealOnes) {
  BeltSession session{frame(), places()};
  const auto fit = grid::fit_belts(measured(session));
  ASSERT_TRUE(fit) << "seed " << session.seed;
  // 150 N over 40,000 N: pulled belts read 0.375 % short; real frames with such belts have 0.9 to
  // 1.6 mm.
  EXPECT_GT(fit->residual_sigma_mm, 3.0 * session.noise_mm);
  EXPECT_LT(fit->residual_sigma_mm, 2.5);
}

}  // namespace
}  // namespace chaintrue::generator
