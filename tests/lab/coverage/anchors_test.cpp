// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of four belts' anchors agree with their stated sigmas.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/belts/belts_fit.hpp"
#include "tests/belts/simulated_belts.hpp"
#include "tests/lab/coverage/rates.hpp"

namespace chaintrue::grid {
namespace {

using belts::anchors_of;
using coverage::seeds;
using coverage::Squares;

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
    place.add(
        Eigen::Vector2d(found.at.x_mm - set.places[17].x_mm, found.at.y_mm - set.places[17].y_mm),
        found.covariance_mm2);
    scatter.add(157.0 * std::pow(fit->residual_sigma_mm / 0.5, 2));
  }
  anchors.expect_unit();
  place.expect_unit();
  scatter.expect_unit();
}

INSTANTIATE_TEST_SUITE_P(Lengths, AnchorCoverage,
                         testing::Values(model::BeltLengths::belt, model::BeltLengths::belt_and_arm,
                                         model::BeltLengths::span),
                         [](const auto& tested) { return std::string(name(tested.param)); });

}  // namespace
}  // namespace chaintrue::grid
