// SPDX-License-Identifier: GPL-3.0-or-later
// Stretching belts and holes in one fit: the stretch is estimated with the anchors and no longer
// distorts them.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/diagnosis/anchors_with_causes.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "model/belts/belt_statics.hpp"
#include "tests/belts/holes_simulation.hpp"

namespace chaintrue::grid::stretch_with_holes {
namespace {

constexpr double kStretch = 0.002;

/// Belts read short by this share at the pull of their motors, in proportion to their tension.
SimulatedHoles stretched(std::uint64_t seed) {
  SimulatedHoles made = simulate_with_holes({.seed = seed});
  int visit = 0;
  for (BeltPoint& point : made.belts.points) {
    point.order = visit++;
    const model::FramePoint place =
        model::place_of_upper(made.truth, point.lengths_mm.tl, point.lengths_mm.tr).value();
    const auto tension =
        model::belts::tensions_of(made.truth, model::belts::kLowerBeltsPulled, 1.0, place);
    for (const model::Belt belt : model::kBelts)
      point.lengths_mm[belt] -= kStretch * tension[belt].value *
                                (point.lengths_mm[belt] - model::reach_mm(made.belts.machine));
  }
  return made;
}

/// Rms error of the five coordinates, in true millimetres.
double off_mm(const SimulatedHoles& truth, const BeltsFit& fit) {
  const belts::AnchorVector off = fit.scale->factor * belts::anchors_of(fit.machine) -
                                  truth.scale * belts::anchors_of(truth.truth);
  return std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
}

TEST(StretchWithHoles, FindsTheStretchAndTheUnstretchedFrame) {
  const SimulatedHoles truth = stretched(1);
  const auto alone = fit_belts_and_holes(truth.belts, {truth.holes});
  const auto counted = diagnosis::fit_with_causes_and_holes(truth.belts, {truth.holes});
  ASSERT_TRUE(alone && counted) << "seed 1";
  ASSERT_FALSE(counted->belts.causes.empty()) << "seed 1";
  const CauseInAnchorFit& found = counted->belts.causes.front();
  EXPECT_EQ(found.effect, "belt_stretch");
  // Four sigmas: one seed in 16 000.
  EXPECT_NEAR(found.parameters.at("elongation"), kStretch, 4.0 * found.sigma) << "seed 1";
  EXPECT_LT(off_mm(truth, counted->belts), 0.7 * off_mm(truth, alone->belts)) << "seed 1";
}

}  // namespace
}  // namespace chaintrue::grid::stretch_with_holes
