// SPDX-License-Identifier: GPL-3.0-or-later
// Belts and holes in one fit, on simulated machines.
#include "grid/belts/belts_and_holes.hpp"

#include <gmock/gmock.h>

#include "grid/belts/belt_map.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tests/belts/holes_simulation.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;

/// Positions over the sheet without holes.
std::vector<BedPoint> targets() {
  std::vector<BedPoint> points;
  for (const double y : {-400.0, -150.0, 200.0, 420.0}) {
    for (const double x : {-900.0, -500.0, -100.0, 350.0, 800.0}) points.push_back({x, y});
  }
  return points;
}

/// The tool's error over the sheet with the belt lengths of the map.
double error_mm(const SimulatedHoles& truth, const BeltMap& map) {
  std::vector<BedPoint> reached;
  for (const BedPoint target : targets()) {
    const auto lengths = map.lengths(target);
    EXPECT_TRUE(lengths);
    const auto machine = map.in_force();
    reached.push_back(truth.tool(*model::span_of(machine, model::Belt::tl, lengths->left_mm),
                                 *model::span_of(machine, model::Belt::tr, lengths->right_mm)));
  }
  return rms_when_laid(reached, targets());
}

TEST(BeltsAndHoles, DetermineTheScale) {
  const SimulatedHoles set = simulate_with_holes({.seed = 300});
  const auto both = fit_belts_and_holes(set.belts, {set.holes});
  ASSERT_TRUE(both) << "seed 300";
  // Four sigmas: one seed in 16 000.
  EXPECT_NEAR(both->belts.scale->factor, set.scale, 4.0 * both->belts.scale->sigma) << "seed 300";
  EXPECT_FALSE(both->holes.displacement) << "seed 300";
}

TEST(BeltsAndHoles, MapFollowsAToolOffsetFromItsBelts) {
  const SimulatedHoles set = simulate_with_holes({.seed = 300, .unmodelled_mm = 4.0});
  const auto alone = fit_belts(set.belts);
  const auto both = fit_belts_and_holes(set.belts, {set.holes});
  ASSERT_TRUE(alone && both) << "seed 300";
  EXPECT_TRUE(both->holes.displacement) << "seed 300";
  EXPECT_LT(error_mm(set, BeltMap(both->belts, &both->holes)),
            0.5 * error_mm(set, BeltMap(*alone, nullptr)))
      << "seed 300";
}

TEST(BeltsAndHoles, RejectAMisreadDistance) {
  SimulatedHoles set = simulate_with_holes({.seed = 77});
  set.holes.set.distances[5].distance_mm += 12.0;
  const auto fit = fit_belts_and_holes(set.belts, {set.holes});
  ASSERT_TRUE(fit);
  for (std::size_t i = 0; i < fit->holes.distances.size(); ++i) {
    EXPECT_EQ(fit->holes.distances[i].rejected, i == 5) << fit->holes.distances[i].words;
  }
  const BeltTapedDistance& rejected = fit->holes.distances[5];
  // Twelve, within the uncertainty of the tape and of nine holes.
  EXPECT_NEAR(rejected.left_out_mm, 12.0, 4.0 * rejected.left_out_sigma_mm);
  // Sigma is that of a new reading: from a fit without the distance, when the distance is read as
  // that fit predicts it. It is then used and changes nothing.
  SimulatedHoles agreeing = set;
  agreeing.holes.set.distances[5].distance_mm -= rejected.left_out_mm;
  const auto counted = fit_belts_and_holes(agreeing.belts, {agreeing.holes});
  ASSERT_TRUE(counted);
  const BeltTapedDistance& same = counted->holes.distances[5];
  ASSERT_FALSE(same.rejected);
  // The point of linearisation is the same up to Newton's tolerance, some 1e-3 mm.
  EXPECT_NEAR(same.left_out_mm, 0.0, 0.01);
  // The noise factor is chosen on a grid, with one more distance: the same step here.
  ASSERT_EQ(counted->holes.noise_factor, fit->holes.noise_factor);
  EXPECT_NEAR(rejected.left_out_sigma_mm, same.left_out_sigma_mm, 0.01 * same.left_out_sigma_mm);
  // At least a tape read to a millimetre, at most the tape plus nine holes measured with it.
  const double tape_mm = set.holes.set.tape.sigma_mm * fit->holes.noise_factor;
  EXPECT_GE(rejected.left_out_sigma_mm, tape_mm);
  EXPECT_LT(rejected.left_out_sigma_mm, 5.0 * tape_mm);
}

TEST(BeltsAndHoles, TheSheetsEdgesFixTheFrame) {
  SimulatedHoles set = simulate_with_holes({.seed = 78, .tape_mm = 0.2, .hole_mm = 0.1});
  MeasuredHoles& holes = set.holes.set;
  holes.tape.sigma_mm = 0.2;
  // The holes' own placement, and a sheet that lies 3 mm to the left and 5 mm lower.
  const auto alone = fit_belts_and_holes(set.belts, {set.holes});
  ASSERT_TRUE(alone);
  const BeltMap unlaid(alone->belts, &alone->holes);
  for (const std::size_t hole : {0, 2, 6, 8}) {
    const BedPoint command = holes.holes[hole].commanded;
    const model::FramePoint meant = model::to_frame(set.holes.machine, command);
    const auto lengths = model::lengths_at(paying_out(set.holes.machine), meant);
    const BedPoint at = *unlaid.tool({lengths->tl, lengths->tr});
    holes.distances.push_back(
        {.from = hole, .edge = SheetEdge::left, .distance_mm = 1219.2 + at.x_mm + 3.0});
    holes.distances.push_back(
        {.from = hole, .edge = SheetEdge::bottom, .distance_mm = 609.6 + at.y_mm + 5.0});
  }
  const auto laid = fit_belts_and_holes(set.belts, {set.holes});
  ASSERT_TRUE(laid && laid->holes.sheet);
  const BeltMap map(laid->belts, &laid->holes);
  const BedPoint moved = *map.tool(*unlaid.lengths({100.0, -50.0}));
  // Half a millimetre for the sheet's size, which affects readings to its edges.
  EXPECT_NEAR(moved.x_mm, 103.0, 1.0);
  EXPECT_NEAR(moved.y_mm, -45.0, 1.0);
}

TEST(BeltMap, LengthsAndToolAreInverse) {
  const SimulatedHoles set = simulate_with_holes({.seed = 9, .unmodelled_mm = 4.0});
  const auto fit = fit_belts_and_holes(set.belts, {set.holes});
  ASSERT_TRUE(fit && fit->holes.displacement);
  const BeltMap map(fit->belts, &fit->holes);
  for (const BedPoint target : targets()) {
    const auto tool = map.tool(*map.lengths(target));
    ASSERT_TRUE(tool);
    EXPECT_NEAR(tool->x_mm, target.x_mm, 1e-8);  // the fixed-point iteration ends at 1e-10 mm
    EXPECT_NEAR(tool->y_mm, target.y_mm, 1e-8);
    const auto sigma = map.sigma(target);
    EXPECT_GT(sigma.left_mm, 0.0);
    EXPECT_LT(sigma.left_mm, 2.0);  // nine holes taped to half a millimetre
  }
}

}  // namespace
}  // namespace chaintrue::grid
