// SPDX-License-Identifier: GPL-3.0-or-later
// Fits to distances between holes: errors of spacing and scales agree with their
// stated sigmas, bad distances are found, plans reach their predicted accuracy; and how often a
// diagnosis names a cause.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/estimation/estimate.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/random.hpp"
#include "sealed/judge/trial.hpp"
#include "tests/holes/hole_sets.hpp"
#include "tests/lab/coverage/rates.hpp"

namespace chaintrue::grid {
namespace {

using coverage::Rate;
using coverage::seeds;
using coverage::Squares;
using testing_support::classic;
using testing_support::nine_holes;
using testing_support::usual_holes;

double spacing(const model::Machine& machine) {
  return machine.motors.right.x_mm - machine.motors.left.x_mm;
}

TEST(HolesCoverage, CoversSpacingAndScales) {
  Squares of_spacing(1.0), scales(2.0);
  double spacing2 = 0.0;
  const auto all = seeds(500);
  for (const std::uint64_t seed : all) {
    synthetic::HolesSpec spec = usual_holes(seed);
    spec.scale_sigma = estimation::kScaleSigma;
    const auto made = synthetic::simulate_holes(nine_holes(), spec);
    const auto fit = joint_fit(made->set);
    ASSERT_TRUE(fit) << "seed " << seed << ": " << fit.error().sentence();
    const Eigen::MatrixXd& c = fit->estimate.knowledge.covariance;
    const double error = spacing(fit->estimate.machine) - spacing(made->truth);
    of_spacing.add(error * error / (c(0, 0) + c(2, 2) - 2.0 * c(0, 2)));
    spacing2 += error * error;
    Eigen::Vector2d off;
    for (const Eigen::Index side : {0, 1}) {
      const double elongation =
          made->truth.effects[static_cast<std::size_t>(side)].parameters.at("elongation");
      off[side] = fit->estimate.knowledge.mean[6 + side] - (1.0 / (1.0 + elongation) - 1.0);
    }
    scales.add(off, c.block(6, 6, 2, 2));
  }
  // The noise is estimated with 15 degrees of freedom besides.
  of_spacing.expect_unit(2.0 / 15.0);
  scales.expect_unit(2.0 / 15.0);
  EXPECT_LT(std::sqrt(spacing2 / static_cast<double>(all.size())), 1.15)
      << "mm, as docs/holes.md states";
}

TEST(HolesCoverage, BadDistancesAreFoundAndGoodOnesKept) {
  Rate found, lost;
  for (const std::uint64_t seed : seeds(100)) {
    auto made = synthetic::simulate_holes(nine_holes(), usual_holes(seed));
    const std::size_t bad = seed % made->set.distances.size();
    made->set.distances[bad].distance_mm += seed % 2 == 0 ? 10.0 : -10.0;
    const auto fit = joint_fit(made->set);
    ASSERT_TRUE(fit) << "seed " << seed;
    const auto& distances = fit->distances.front().distances;
    for (std::size_t k = 0; k < distances.size(); ++k)
      (k == bad ? found : lost).add(distances[k].rejected);
  }
  found.expect_at_least(0.97);
  lost.expect_at_most(0.003);  // 0.0016 by chance, and some beside a bad one
}

TEST(HolesCoverage, PlansWithEdgesKeepTheirPromise) {
  const auto plan = plan_holes(classic(), {.holes = 9, .edges = true});
  ASSERT_TRUE(plan);
  Random size(77);
  // Shift and rotation of the sheet dominate: three free numbers for each set.
  Squares error(3.0);
  for (const std::uint64_t seed : seeds(200)) {
    synthetic::HolesSpec spec = usual_holes(seed);
    spec.scale_sigma = estimation::kScaleSigma;
    spec.sheet = {12.0, -9.0, 0.006};
    MeasuredHoles design = plan->set;
    design.sheet.width_mm = classic().bed.width_mm + design.sheet.size_sigma_mm * size.normal();
    design.sheet.height_mm = classic().bed.height_mm + design.sheet.size_sigma_mm * size.normal();
    auto made = synthetic::simulate_holes(design, spec);
    ASSERT_TRUE(made) << "seed " << seed;
    made->set.sheet = plan->set.sheet;
    const auto fit = joint_fit(made->set);
    ASSERT_TRUE(fit) << "seed " << seed;
    const double true_mm = testing_support::tool_rms_mm(fit->map, made->truth, spec.sheet);
    error.add(3.0 * std::pow(true_mm / plan->expected_rms_mm, 2));
  }
  error.expect_unit();
}

std::vector<sealed::Claim> named(const std::vector<model::AppliedEffect>& hidden,
                                 std::uint64_t seed) {
  synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.seed = seed;
  spec.hidden = hidden;
  const MeasuredHoles set = synthetic::simulate_holes(nine_holes(), spec)->set;
  return sealed::named_causes(diagnosis::diagnose(set, sealed::verdict_alone()).value());
}

TEST(HolesVerdicts, NameNothingOnSoundMachines) {
  Rate false_alarms;
  for (const std::uint64_t seed : seeds(200)) false_alarms.add(!named({}, seed).empty());
  false_alarms.expect_at_most(0.01);
}

TEST(HolesVerdicts, NameSingleCauses) {
  // Each with a size that a workshop would notice: a strength of seven and more.
  for (const model::AppliedEffect& hidden :
       {model::AppliedEffect{"chain_pitch_error", "left", {{"elongation", 0.0015}}},
        model::AppliedEffect{"chain_pitch_error", "both", {{"elongation", 0.002}}},
        model::AppliedEffect{"tape_scale", "both", {{"scale", 0.002}}},
        model::AppliedEffect{"ring_radius", "", {{"offset_mm", 10.0}}},
        model::AppliedEffect{"chain_sag", "", {{"relative_weight", 0.5}}},
        model::AppliedEffect{"side_pull", "", {{"force_n", 8.0}}},
        model::AppliedEffect{"chain_stretch", "", {{"compliance_per_n", 2e-5}}},
        model::AppliedEffect{"beam_flex", "", {{"flexibility_mm_per_n", 0.03}}},
        model::AppliedEffect{
            "angular_kink", "left", {{"slope_mm_per_rad", 20.0}, {"knee_rad", 0.6}}}}) {
    SCOPED_TRACE(hidden.effect + hidden.side);
    Rate first, misnamed;
    const auto means = [id = sealed::id_of(hidden.effect, hidden.side)](
                           const sealed::Claim& claim) { return claim.means(id); };
    for (const std::uint64_t seed : seeds(40)) {
      const auto causes = named({hidden}, seed);
      if (causes.empty()) continue;
      first.add(means(causes.front()));
      misnamed.add(std::ranges::none_of(causes, means));
    }
    first.expect_at_least(0.9);
    misnamed.expect_at_most(0.05);
  }
}

}  // namespace
}  // namespace chaintrue::grid
