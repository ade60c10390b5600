// SPDX-License-Identifier: GPL-3.0-or-later
// The joint estimate: any mix of observations, one loop of reweighting.
#include "grid/estimation/estimate.hpp"
#include "grid/estimation/reading_shifts.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grid/map/fitted_points.hpp"
#include "grid/map/joint_fit.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid {
namespace {

using testing::HasSubstr;
using testing_support::classic;
using testing_support::cut_holes;
using testing_support::nine_holes;
using testing_support::usual_holes;

/// One machine with measured points and nine holes.
struct Owner {
  MeasuredGrid points;
  MeasuredHoles holes;
};

/// Effects that no setting and no scale explains.
enum class Beyond { nothing, beam_and_hose };

Owner owner(std::uint64_t seed, int columns, int rows, Beyond beyond = Beyond::nothing) {
  synthetic::SyntheticSpec spec = testing_support::usual_spec(seed);
  spec.design.columns = columns;
  spec.design.rows = rows;
  spec.repeats = 0;
  const double elongation = 0.0005 * (static_cast<double>(seed % 5) - 2.0);
  spec.hidden = {{"chain_pitch_error", "left", {{"elongation", elongation}}},
                 {"chain_pitch_error", "right", {{"elongation", -elongation}}}};
  if (beyond == Beyond::beam_and_hose) {
    spec.hidden.push_back({"beam_flex", "", {{"flexibility_mm_per_n", 0.01}}});
    spec.hidden.push_back({"side_pull", "", {{"force_n", 3.0}}});
  }
  const auto session = synthetic::generate(classic(), spec);
  const auto cut =
      synthetic::simulate_holes(nine_holes(), usual_holes(seed), session->answer.machine);
  return {session->grid, cut->set};
}

TEST(Estimate, FileOrderMovesOnlyTheFrame) {
  const Owner own = owner(3, 4, 3);
  const auto one = joint_fit({{"points", own.points}, {"holes", own.holes}});
  const auto other = joint_fit({{"holes", own.holes}, {"points", own.points}});
  ASSERT_TRUE(one && other);
  const auto& a = one->estimate.knowledge;
  const auto& b = other->estimate.knowledge;
  for (Eigen::Index i = 0; i < estimation::kMachineUnknowns; ++i) {
    // Each converges to 1e-3 of the stated sigmas; the surface is in the first one's frame, which
    // is a millimetre off.
    EXPECT_NEAR(a.mean[i], b.mean[i], 0.05 * std::sqrt(a.covariance(i, i))) << i;
  }
  // The frame of a sheet without edges: on average its holes are at their commanded positions.
  double x = 0.0;
  for (std::size_t i = 0; i < own.holes.holes.size(); ++i)
    x += other->distances.front().holes[i].predicted.x_mm - own.holes.holes[i].commanded.x_mm;
  EXPECT_NEAR(x, 0.0, 0.02) << "the last pass moved less than 1e-3 sigmas";
}

estimation::EstimationInput of_distances(const MeasuredHoles& set) {
  estimation::EstimationInput input;
  input.machine = *set.machine;
  input.observations = {std::make_shared<const observation::TapeDistances>(
      *observation::TapeDistances::in_given_order(set))};
  input.noise = {interp::NoiseKnowledge::from_repeats, set.noise_dof};
  input.surface = estimation::SurfaceUse::none;
  input.domain = holes_domain(set.machine->bed);
  return input;
}

/// Points and distances of exactly known noise.
estimation::EstimationInput of_both(const Owner& own) {
  estimation::EstimationInput input = of_distances(own.holes);
  input.observations.insert(
      input.observations.begin(),
      std::make_shared<const observation::ChainLengthReadings>(
          chain_length_readings(*length_points(own.points), {0.2, 0.3}, 15.0, std::nullopt)));
  input.noise = {interp::NoiseKnowledge::exact, 0.0};
  return input;
}

TEST(Estimate, PointsAndDistancesTogetherKnowMoreThanEither) {
  for (const Beyond beyond : {Beyond::nothing, Beyond::beam_and_hose}) {
    const Owner own = owner(1, 4, 3, beyond);
    const auto sigma_of = [](const estimation::EstimationInput& input) {
      const auto found = estimation::estimate(input);
      EXPECT_TRUE(found->converged);
      return tool_sigma_mm(classic(), found->knowledge.covariance);
    };
    const auto both = of_both(own);
    const double together = sigma_of(both);
    for (const auto& one : both.observations) {
      auto alone = both;
      alone.observations = {one};
      EXPECT_LT(together, sigma_of(alone)) << one->kind().id;
    }
    const auto fit = joint_fit({{"points", own.points}, {"holes", own.holes}});
    EXPECT_TRUE(fit && fit->estimate.converged);
  }
}

TEST(Estimate, ReadingsThatSayNothingLeaveWhatWasStated) {
  constexpr double kNothingMm = 1e6;
  const Owner own = owner(1, 4, 3);
  auto input = of_both(own);
  input.observations = {
      std::make_shared<const observation::ChainLengthReadings>(chain_length_readings(
          *length_points(own.points), {kNothingMm, kNothingMm}, 15.0, std::nullopt))};
  const auto found = estimation::estimate(input);
  ASSERT_TRUE(found);
  const Eigen::MatrixXd stated = estimation::stated_knowledge(input.machine).covariance;
  for (Eigen::Index i = 0; i < estimation::kMachineUnknowns; ++i) {
    SCOPED_TRACE(i);
    // A scale moves a length by 4,000 mm per unit, 8 mm a sigma: of the variance, 24 readings take 2e-9.
    EXPECT_NEAR(found->knowledge.covariance(i, i) / stated(i, i), 1.0, 1e-6);
    EXPECT_NEAR(found->knowledge.mean[i], 0.0, 1e-4 * std::sqrt(stated(i, i)));
  }
}

TEST(Estimate, UnitResultsUseTheFitsFinalWeights) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    SCOPED_TRACE(seed);
    auto made = cut_holes(seed);
    made.set.distances[3].distance_mm += 10.0;
    estimation::EstimationInput input = of_distances(made.set);
    // The fifth iteration is the first that may reject a reading.
    input.most_passes = 5;
    const auto cut_short = estimation::estimate(input);
    ASSERT_TRUE(cut_short);
    EXPECT_FALSE(cut_short->converged);
    EXPECT_FALSE(cut_short->units[3].is_rejected()) << "the fit has it";
    // A fit with the reported weights gives the same result, up to the remaining change.
    Eigen::VectorXd weights(static_cast<Eigen::Index>(cut_short->units.size()));
    for (Eigen::Index u = 0; u < weights.size(); ++u)
      weights[u] = cut_short->units[static_cast<std::size_t>(u)].weight;
    input.most_passes = 0;
    input.fixed_weights = weights;
    const auto again = estimation::estimate(input);
    ASSERT_TRUE(again);
    EXPECT_NEAR(again->noise_factor, cut_short->noise_factor, 1e-3);
    for (std::size_t u = 0; u < again->units.size(); ++u)
      EXPECT_NEAR(again->units[u].left_out[0], cut_short->units[u].left_out[0], 0.02);
  }
}

TEST(Estimate, LeftOutUnitEqualsAFitWithoutIt) {
  const Owner own = owner(8, 4, 3);
  estimation::EstimationInput input = of_both(own);
  const auto units =
      static_cast<Eigen::Index>(own.points.points.size() + own.holes.distances.size());
  input.fixed_weights = Eigen::VectorXd::Ones(units);
  const auto whole = estimation::estimate(input);
  ASSERT_TRUE(whole);
  for (const Eigen::Index out : {Eigen::Index{0}, Eigen::Index{7}, units - 3}) {
    input.fixed_weights = Eigen::VectorXd::Ones(units);
    (*input.fixed_weights)[out] = 0.0;
    const auto without = estimation::estimate(input);
    ASSERT_TRUE(without);
    const auto& reply = whole->units[static_cast<std::size_t>(out)];
    const auto& conditioned = without->units[static_cast<std::size_t>(out)];
    // The two differ by the curvature of the model over the change by one outlier group, a few 1e-3
    // mm.
    EXPECT_LT((reply.left_out - conditioned.left_out).cwiseAbs().maxCoeff(), 0.01);
    EXPECT_NEAR(reply.distance, conditioned.distance, 0.02);
  }
}

TEST(FitTogether, RefusesAnotherMachine) {
  Owner own = owner(2, 4, 3);
  own.holes.machine->motors.left.x_mm -= 5.0;
  const auto fit = joint_fit({{"points.json", own.points}, {"holes.json", own.holes}});
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().sentence(),
              testing::AllOf(HasSubstr("holes.json"), HasSubstr("motor_left_x_mm is")));
  own.holes.machine.reset();
  const auto none = joint_fit({{"points.json", own.points}, {"holes.json", own.holes}});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().sentence(), HasSubstr("holes.json has no machine"));
  EXPECT_THROW((void)joint_fit({}), std::invalid_argument);
}

TEST(FitTogether, MapListsTheSourceOfEachPart) {
  Owner own = owner(4, 4, 3);
  own.holes.distances[5].distance_mm += 12.0;
  const auto fit = joint_fit({{"points.json", own.points}, {"holes.json", own.holes}});
  ASSERT_TRUE(fit);
  const auto& notes = fit->map.contents().notes;
  EXPECT_THAT(notes, testing::Contains(HasSubstr("12 points of points.json")));
  EXPECT_THAT(notes, testing::Contains(
                         HasSubstr("20 distances between 9 holes of holes.json (1 left out)")));
  EXPECT_THAT(notes, testing::Contains(
                         HasSubstr("holes.json: " + words_of(own.holes, own.holes.distances[5]))));
}

TEST(NormalDeviate, HasTheChanceOfStudentsT) {
  // Two-sided quantiles of 5 % and of 0.1 %: M. Abramowitz and I. Stegun, Handbook of Mathematical
  // Functions (1964), table 26.10.
  struct Quantile {
    double dof, t, normal;
  };
  for (const Quantile& q : {Quantile{5.0, 2.571, 1.960},
                            {10.0, 2.228, 1.960},
                            {30.0, 2.042, 1.960},
                            {10.0, 4.587, 3.291}})
    EXPECT_NEAR(estimation::normal_deviate(q.t, q.dof), q.normal, 0.01)
        << q.dof << " degrees of freedom; Wallace's bound there";
}

}  // namespace
}  // namespace chaintrue::grid
