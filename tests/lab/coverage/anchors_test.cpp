// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of four belts' anchors agree with their stated sigmas; bad readings are found and good
// ones kept.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/belts/belts_fit.hpp"
#include "grid/random.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tests/belts/holes_simulation.hpp"
#include "tests/belts/simulated_belts.hpp"
#include "tests/lab/coverage/rates.hpp"

namespace chaintrue::grid {
namespace {

using belts::anchors_of;
using coverage::Rate;
using coverage::seeds;
using coverage::Squares;
using model::Belt;

Eigen::VectorXd anchors_error(const BeltsFit& fit, const SimulatedBelts& set) {
  return anchors_of(fit.machine) - anchors_of(set.truth);
}

class AnchorCoverage : public testing::TestWithParam<model::BeltLengths> {};

TEST_P(AnchorCoverage, CoversAnchorsPlacesAndScatter) {
  Squares anchors(5.0), place(2.0), scatter(157.0);
  for (const std::uint64_t seed : seeds(150)) {
    const SimulatedBelts set = simulate({.seed = seed, .lengths = GetParam()});
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit) << "seed " << seed << ": " << fit.error().sentence();
    anchors.add(anchors_error(*fit, set), fit->covariance_mm2);
    const FittedPlace& found = fit->places[17];
    place.add(Eigen::Vector2d(found.at.x_mm - set.places[17].x_mm, found.at.y_mm - set.places[17].y_mm),
              found.covariance_mm2);
    scatter.add(157.0 * std::pow(fit->residual_sigma_mm / 0.5, 2));
  }
  anchors.expect_unit();
  place.expect_unit();
  scatter.expect_unit();
}

INSTANTIATE_TEST_SUITE_P(Lengths,
                         AnchorCoverage,
                         testing::Values(model::BeltLengths::belt,
                                         model::BeltLengths::belt_and_arm,
                                         model::BeltLengths::span),
                         [](const auto& tested) { return std::string(name(tested.param)); });

TEST(ScaleCoverage, CoversTheScaleFromTapes) {
  constexpr double kTapeMm = 0.7;
  constexpr double kTrueScale = 0.996;
  Squares scale(1.0), anchors(5.0);
  for (const std::uint64_t seed : seeds(80)) {
    SimulatedBelts set = simulate({.seed = seed});
    Random random(seed, 77);
    const auto taped = [&](BeltEnd from, BeltEnd to, model::FramePoint a, model::FramePoint b) {
      const double distance = kTrueScale * std::hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm);
      set.belts.distances.push_back({from, to, distance + kTapeMm * random.normal(), kTapeMm});
    };
    const auto& a = set.truth.anchors;
    taped(Belt::tl, Belt::tr, {a.tl.x_mm, a.tl.y_mm}, {a.tr.x_mm, a.tr.y_mm});
    taped(std::size_t{0}, std::size_t{80}, set.places[0], set.places[80]);
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit && fit->scale) << "seed " << seed;
    scale.add(std::pow((fit->scale->factor - kTrueScale) / fit->scale->sigma, 2));
    anchors.add(anchors_error(*fit, set), fit->covariance_mm2);
  }
  scale.expect_unit();
  anchors.expect_unit();
}

TEST(ScaleCoverage, CoversTheScaleFromHoles) {
  Squares scale(1.0);
  for (const std::uint64_t seed : seeds(60)) {
    const SimulatedHoles set = simulate_with_holes({.seed = 500 + seed, .few_holes = true});
    const auto fit = fit_belts_and_holes(set.belts, {set.holes});
    ASSERT_TRUE(fit) << "seed " << seed;
    scale.add(std::pow((fit->belts.scale->factor - set.scale) / fit->belts.scale->sigma, 2));
  }
  scale.expect_unit();
}

TEST(BadBeltReadings, AreNamedAndGoodOnesAreKept) {
  Rate named, kept;
  for (const std::uint64_t seed : seeds(60)) {
    SimulatedBelts set = simulate({.seed = 500 + seed});
    kept.add(fit_belts(set.belts)->bad.empty());
    const std::size_t point = 7 * seed % 81;
    const Belt belt = model::kBelts[seed % 4];
    set.belts.points[point].lengths_mm[belt] += seed % 2 == 0 ? 80.0 : -80.0;
    const auto fit = fit_belts(set.belts);
    ASSERT_TRUE(fit) << "seed " << seed;
    named.add(fit->bad.size() == 1 && fit->bad[0].point == point && fit->bad[0].belt == belt);
  }
  named.expect_at_least(0.97);  // the required rate
  kept.expect_at_least(0.9977);  // 324 readings of chance 7e-6 each
}

}  // namespace
}  // namespace chaintrue::grid
