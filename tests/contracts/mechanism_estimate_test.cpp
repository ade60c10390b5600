// SPDX-License-Identifier: GPL-3.0-or-later
/// The estimator works for any mechanism: one that the product does not contain is calibrated from
/// its lengths at known positions, four belts from theirs at unknown positions.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "grid/estimation/estimate.hpp"
#include "grid/observation/belt_lengths.hpp"
#include "grid/random.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "tests/contracts/toy_mechanism.hpp"

namespace chaintrue::grid::estimation {
namespace {

using observation::BeltLengthReadings;
using observation::LengthsAtPlace;

constexpr double kNoiseMm = 0.4;

/// 24 positions over the middle of the mechanism's extent.
std::vector<LengthsAtPlace> read_lengths(const model::Mechanism& truth,
                                         bool known,
                                         Random& random) {
  const model::MechanismExtent e = truth.extent();
  std::vector<LengthsAtPlace> places;
  for (const double y : {0.25, 0.4, 0.6, 0.75}) {
    for (const double x : {0.2, 0.3, 0.45, 0.55, 0.7, 0.8}) {
      const model::ToolPosition at{e.x_min_mm + x * (e.x_max_mm - e.x_min_mm),
                                   e.y_min_mm + y * (e.y_max_mm - e.y_min_mm)};
      LengthsAtPlace place;
      place.index = places.size();
      place.name = std::to_string(places.size() + 1);
      place.lengths_mm = truth.predict(at, {})->lengths_mm;
      for (double& length : place.lengths_mm) length += kNoiseMm * random.normal();
      if (known) place.known = at;
      places.push_back(std::move(place));
    }
  }
  return places;
}

/// The mean square of the parameters' errors in their own covariance, and that of the estimated
/// noise.
struct Calibrations {
  double parameters = 0.0;
  double noise = 0.0;
};

Calibrations calibrate(const model::Mechanism& truth,
                       const std::shared_ptr<const model::Mechanism>& start,
                       bool known,
                       int sets) {
  Calibrations mean;
  for (int seed = 1; seed <= sets; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 91);
    const auto readings = std::make_shared<const BeltLengthReadings>(
        read_lengths(truth, known, random), false, observation::BeltNoise{.length_mm = 1.0}, 0.0);
    EstimationInput input;
    input.mechanism = start;
    input.observations = {readings};
    input.noise.knowledge = interp::NoiseKnowledge::unknown;
    input.noise_prior = interp::SmoothingPrior::none;
    input.surface = SurfaceUse::none;
    input.domain = {0.0, 1.0, 0.0, 1.0};
    input.fixed_weights =
        Eigen::VectorXd::Ones(static_cast<Eigen::Index>(readings->units().size()));
    const auto found = estimate(input);
    EXPECT_TRUE(found) << "seed " << seed;
    if (!found) continue;
    EXPECT_TRUE(found->converged) << "seed " << seed;
    const Eigen::Index p = truth.values().size();
    const Eigen::VectorXd error = found->mechanism->values() - truth.values();
    mean.parameters += error.dot(found->covariance.topLeftCorner(p, p).ldlt().solve(error)) / sets;
    mean.noise += found->noise_factor * found->noise_factor / sets;
  }
  return mean;
}

TEST(MechanismEstimate, AToyIsCalibratedFromLengthsAtKnownPositions) {
  constexpr int kSets = 100;
  // The left nail is at its stated position; the right one has no prior, and starts elsewhere.
  const model::ToyMechanism truth(-1000.0, 1200.0);
  const auto start = std::make_shared<const model::ToyMechanism>(-1000.0, 1230.0);
  const Calibrations found = calibrate(truth, start, true, kSets);
  // Three parameters over 69 degrees of freedom; four sigmas of the mean, and of that of a variance.
  EXPECT_NEAR(found.parameters, 3.0, 4.0 * std::sqrt(6.0 / kSets) + 2.0 * 3.0 / 67.0)
      << "seeds 1 to " << kSets;
  EXPECT_NEAR(found.noise / (kNoiseMm * kNoiseMm), 1.0, 4.0 * std::sqrt(2.0 / (69.0 * kSets)));
}

TEST(MechanismEstimate, CalibratesFourBeltsFromUnmeasuredPositions) {
  constexpr int kSets = 60;
  model::BeltMachine machine;
  machine.anchors_known = true;
  machine.anchors = {
      {-27.6, 2064.9, 100.0}, {2924.3, 2066.5, 56.0}, {0.0, 0.0, 34.0}, {2953.2, 0.0, 78.0}};
  const auto truth = model::make_belt_mechanism(machine);
  const Eigen::VectorXd off = (Eigen::VectorXd(5) << 9.0, -11.0, -8.0, 10.0, 12.0).finished();
  const Calibrations found =
      calibrate(*truth, truth->with_values(truth->values() + off), false, kSets);
  // Five coordinates over 2 x 24 - 5 checks, as above.
  EXPECT_NEAR(found.parameters, 5.0, 4.0 * std::sqrt(10.0 / kSets) + 2.0 * 5.0 / 41.0)
      << "seeds 1 to " << kSets;
  EXPECT_NEAR(found.noise / (kNoiseMm * kNoiseMm), 1.0, 4.0 * std::sqrt(2.0 / (43.0 * kSets)));
}

}  // namespace
}  // namespace chaintrue::grid::estimation
