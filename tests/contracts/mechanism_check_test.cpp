// SPDX-License-Identifier: GPL-3.0-or-later
/// A mechanism of any kind is calibrated with the stated errors, and then gives a map that answers
/// both ways and a check by new readings. Two chains, four belts and a toy that no product code
/// knows are fitted from readings at known positions and, if their lengths check each other, at
/// some that nobody measured.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <ostream>

#include "grid/estimation/estimate.hpp"
#include "grid/map/mechanism_map.hpp"
#include "grid/random.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "model/reading_model.hpp"
#include "tests/contracts/toy_mechanism.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid {
namespace {

using model::Mechanism;
using observation::LengthsAtPlace;
using MechanismPtr = std::shared_ptr<const Mechanism>;

constexpr double kNoiseMm = 0.3;

/// A mechanism, with changes that re-zeroing corrects and that it does not.
struct Hung {
  std::string name;
  std::function<MechanismPtr()> make;
  bool some_unknown = true;  ///< its lengths check each other
  std::function<MechanismPtr(const Mechanism&)> moved;
  std::vector<std::size_t> lengths_of_a_zero;
};

void PrintTo(const Hung& hung, std::ostream* out) { *out << hung.name; }

MechanismPtr shifted(const Mechanism& mechanism, Eigen::Index parameter, double by) {
  Eigen::VectorXd values = mechanism.values();
  values[parameter] += by;
  return mechanism.with_values(values);
}

std::vector<Hung> every_mechanism() {
  return {{"chains",
           [] { return model::make_chain_mechanism(model::Machine{}); },
           false,
           // Both motors shifted equally in x: no zero has that effect in all directions.
           [](const Mechanism& m) { return shifted(*shifted(m, 0, 9.0), 3, -9.0); },
           {0}},
          {"belts",
           [] { return model::make_belt_mechanism(testing_support::stated()); },
           true,
           [](const Mechanism& m) { return shifted(m, 2, 12.0); },
           {3}},
          {"toy",
           [] { return std::make_shared<const model::ToyMechanism>(-1000.0, 1200.0); },
           true,
           [](const Mechanism& m) { return shifted(m, 0, 9.0); },
           {0, 1, 2}}};
}

/// `columns` by `rows` places over the middle of what the mechanism reaches, each with noise; every
/// third at an unknown position if `some_unknown`.
std::vector<LengthsAtPlace> read(const Mechanism& truth, int columns, int rows, bool some_unknown,
                                 Random& random) {
  const model::MechanismExtent e = truth.extent();
  std::vector<LengthsAtPlace> places;
  for (int iy = 0; iy < rows; ++iy) {
    for (int ix = 0; ix < columns; ++ix) {
      const model::ToolPosition at{
          e.x_min_mm + (0.2 + 0.6 * ix / (columns - 1)) * (e.x_max_mm - e.x_min_mm),
          e.y_min_mm + (0.2 + 0.6 * iy / (rows - 1)) * (e.y_max_mm - e.y_min_mm)};
      LengthsAtPlace place;
      place.index = places.size();
      place.name = std::to_string(places.size() + 1);
      place.lengths_mm = truth.predict(at, {})->lengths_mm;
      for (double& length : place.lengths_mm) length += kNoiseMm * random.normal();
      if (!some_unknown || places.size() % 3 != 2) place.known = at;
      places.push_back(std::move(place));
    }
  }
  return places;
}

CheckWords words() {
  return {"the calibration", "readings",
          "It is valid",     "It is valid after re-zeroing",
          "Measure again",   [](const CheckHypothesis& h) { return "a change of " + h.side; }};
}

class CalibratedMechanism : public testing::TestWithParam<Hung> {
 protected:
  /// The estimate begins at a mechanism some millimetres off.
  static FittedMechanism fitted(const Hung& hung, Random& random) {
    const MechanismPtr truth = hung.make();
    const auto readings = std::make_shared<const observation::BeltLengthReadings>(
        read(*truth, 6, 4, hung.some_unknown, random), false,
        observation::BeltNoise{.length_mm = 1.0}, 0.0);
    estimation::EstimationInput input;
    input.mechanism = hung.moved(*truth);
    input.observations = {readings};
    input.noise.knowledge = interp::NoiseKnowledge::unknown;
    input.noise_prior = interp::SmoothingPrior::none;
    input.surface = estimation::SurfaceUse::none;
    input.domain = {0.0, 1.0, 0.0, 1.0};
    input.fixed_weights =
        Eigen::VectorXd::Ones(static_cast<Eigen::Index>(readings->units().size()));
    const auto found = estimation::estimate(input);
    EXPECT_TRUE(found && found->converged);
    const Eigen::Index p = truth->values().size();
    return {found->mechanism, found->covariance.topLeftCorner(p, p), found->noise_factor,
            static_cast<double>(readings->rows() - p)};
  }

  /// The verdict of checks of six new places.
  static void expect_verdict(CheckVerdict verdict, bool is_moved, double zero_mm) {
    const Hung& hung = GetParam();
    const MechanismPtr now = is_moved ? hung.moved(*hung.make()) : hung.make();
    // For 40 sets four may miss a verdict that is right nineteen times in twenty; more do in one run
    // in twenty.
    constexpr int kSets = 40, kMostWrong = 4;
    int right = 0;
    for (int seed = 1; seed <= kSets; ++seed) {
      Random random(static_cast<std::uint64_t>(seed), 23);
      const FittedMechanism fit = fitted(hung, random);
      auto places = read(*now, 3, 2, hung.some_unknown, random);
      for (LengthsAtPlace& place : places) {
        for (const std::size_t i : hung.lengths_of_a_zero)
          place.lengths_mm[static_cast<Eigen::Index>(i)] += zero_mm;
      }
      const auto check = check_lengths(fit, places, words());
      ASSERT_TRUE(check) << "seed " << seed;
      EXPECT_NEAR(check->probability[0] + check->probability[1] + check->probability[2], 1.0, 1e-9);
      EXPECT_FALSE(check->sentence.empty());
      right += check->verdict == verdict ? 1 : 0;
    }
    EXPECT_GE(right, kSets - kMostWrong) << "seeds 1 to " << kSets;
  }
};

TEST_P(CalibratedMechanism, ErrorsHaveTheirCovarianceAndReadingsTheNoise) {
  constexpr int kFits = 100;
  const MechanismPtr truth = GetParam().make();
  const auto p = static_cast<double>(truth->values().size());
  double squares = 0.0, noise = 0.0, by_priors = 0.0, dof = 0.0;
  for (int seed = 1; seed <= kFits; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 91);
    const FittedMechanism fit = fitted(GetParam(), random);
    const Eigen::VectorXd error = fit.mechanism->values() - truth->values();
    squares += error.dot(fit.covariance.ldlt().solve(error)) / kFits;
    noise += std::pow(fit.length_mm / kNoiseMm, 2) / kFits;
    dof = fit.noise_dof;
    by_priors = 0.0;
    for (Eigen::Index i = 0; i < error.size(); ++i) {
      if (const auto sigma = truth->parameters()[static_cast<std::size_t>(i)].prior_sigma)
        by_priors += fit.covariance(i, i) / (*sigma * *sigma);
    }
  }
  // A true value is its stated one: what its prior adds to the information adds nothing to the error.
  // Four sigmas of the mean, and of that of a variance.
  EXPECT_NEAR(squares, p - by_priors, 4.0 * std::sqrt(2.0 * p / kFits) + 2.0 * p / (dof - 2.0))
      << "seeds 1 to " << kFits;
  EXPECT_NEAR(noise, 1.0, 4.0 * std::sqrt(2.0 / (dof * kFits)));
}

TEST_P(CalibratedMechanism, MapsForwardAndInverse) {
  Random random(1, 17);
  const FittedMechanism fit = fitted(GetParam(), random);
  const model::MechanismExtent e = fit.mechanism->extent();
  const MechanismMap map = MechanismMap::of(
      fit, {{e.x_min_mm, e.y_min_mm}, {e.x_max_mm, e.y_min_mm}, {e.centre().x_mm, e.y_max_mm}});
  ASSERT_EQ(map.length_names().size(), fit.mechanism->lengths().size());
  for (int k = 0; k < 200; ++k) {
    const model::BedPoint at{random.uniform(e.x_min_mm, e.x_max_mm),
                             random.uniform(e.y_min_mm, e.y_max_mm)};
    const auto answer = map.query(at);
    ASSERT_TRUE(answer) << answer.error().sentence();
    ASSERT_EQ(answer->lengths_mm.size(), std::ssize(map.length_names()));
    const auto first = map.lengths(at);
    ASSERT_TRUE(first);
    // Rounding of lengths of 3 m.
    EXPECT_NEAR(first->left_mm, answer->lengths_mm[0], 1e-11);
    EXPECT_NEAR(first->right_mm, answer->lengths_mm[1], 1e-11);
    const auto tool = map.tool({answer->lengths_mm[0], answer->lengths_mm[1]});
    ASSERT_TRUE(tool) << tool.error().sentence();
    // Newton's tolerance.
    EXPECT_NEAR(tool->x_mm, at.x_mm, 1e-9);
    EXPECT_NEAR(tool->y_mm, at.y_mm, 1e-9);
    EXPECT_GT(answer->sigma.left_mm, 0.0);
  }
  const auto beyond = map.query({e.x_max_mm + 1.0, e.y_min_mm});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error(), MapReason::outside_map);
}

TEST_P(CalibratedMechanism, SigmasFollowFromItsParameters) {
  Random random(2, 17);
  const FittedMechanism fit = fitted(GetParam(), random);
  const model::ToolPosition at = fit.mechanism->extent().centre();
  const MechanismMap map =
      MechanismMap::of(fit, {{at.x_mm, at.y_mm}, {at.x_mm + 9.0, at.y_mm}, {at.x_mm, at.y_mm + 9}});
  const Eigen::MatrixXd by = fit.mechanism->predict(at, {})->by_parameter;
  const Eigen::VectorXd variance = (by * fit.covariance * by.transpose()).diagonal();
  const model::ChainLengths sigma = map.sigma({at.x_mm, at.y_mm});
  // The curvature over one sigma of a few millimetres in 1 m.
  EXPECT_NEAR(sigma.left_mm / std::sqrt(variance[0]), 1.0, 1e-2);
  EXPECT_NEAR(sigma.right_mm / std::sqrt(variance[1]), 1.0, 1e-2);
}

TEST_P(CalibratedMechanism, FreshReadingsConfirmIt) {
  expect_verdict(CheckVerdict::valid, false, 0.0);
}

TEST_P(CalibratedMechanism, ProposesRezeroingForAShiftedZero) {
  expect_verdict(CheckVerdict::valid_after_rezeroing, false, 5.0);
}

TEST_P(CalibratedMechanism, AsksForNewMeasurementsWhereRezeroingFails) {
  expect_verdict(CheckVerdict::measure_again, true, 0.0);
}

TEST_P(CalibratedMechanism, NamesASingleBadReading) {
  Random random(3, 29);
  const FittedMechanism fit = fitted(GetParam(), random);
  auto places = read(*GetParam().make(), 3, 2, GetParam().some_unknown, random);
  places[3].lengths_mm[0] += 25.0;
  const auto check = check_lengths(fit, places, words());
  ASSERT_TRUE(check);
  EXPECT_EQ(check->hypotheses.front().what, model::Change::bad_point);
  EXPECT_EQ(check->hypotheses.front().count, 3);
  EXPECT_EQ(check->verdict, CheckVerdict::measure_again);
  EXPECT_NE(check->sentence.find("point 4"), std::string::npos) << check->sentence;
}

INSTANTIATE_TEST_SUITE_P(All, CalibratedMechanism, testing::ValuesIn(every_mechanism()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace chaintrue::grid
