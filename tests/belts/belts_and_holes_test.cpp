// SPDX-License-Identifier: GPL-3.0-or-later
// Belts and holes in one fit, on simulated machines: the accuracy of either alone, and of both
// together.
#include "grid/belts/belts_and_holes.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

#include "grid/belts/belt_map.hpp"
#include "grid/statistics.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tests/belts/holes_simulation.hpp"

namespace chaintrue::grid {
namespace {

using belts::anchors_of;
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

MeasuredBelts without_points(MeasuredBelts belts) {
  belts.points.clear();
  return belts;
}

/// Rms error of the five coordinates, in true millimetres.
double anchors_off_mm(const SimulatedHoles& truth, const BeltsFit& fit) {
  const double factor = fit.scale ? fit.scale->factor : 1.0;
  const belts::AnchorVector off =
      factor * anchors_of(fit.machine) - truth.scale * anchors_of(truth.truth);
  return std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
}

/// Rms over many machines: of the tool over the sheet, and of the anchors.
struct Errors {
  std::vector<double> tool_mm;
  std::vector<double> anchors_mm;
  void add(const SimulatedHoles& truth, const BeltsFit& fit, const HolesWithBelts* holes) {
    tool_mm.push_back(error_mm(truth, BeltMap(fit, holes)));
    anchors_mm.push_back(anchors_off_mm(truth, fit));
  }
};

struct Compared {
  Errors belts;
  Errors holes;
  Errors both;
  int bent = 0;  ///< machines for which both fits find a displacement
};

Compared compared(HolesSimulation simulation, int machines) {
  Compared found;
  for (int k = 0; k < machines; ++k) {
    simulation.seed = 300 + static_cast<std::uint64_t>(k);
    const SimulatedHoles set = simulate_with_holes(simulation);
    const auto alone = fit_belts(set.belts);
    const auto taped = fit_belts_and_holes(without_points(set.belts), {set.holes});
    const auto both = fit_belts_and_holes(set.belts, {set.holes});
    EXPECT_TRUE(alone && taped && both) << "seed " << simulation.seed;
    if (!alone || !taped || !both) continue;
    found.belts.add(set, *alone, nullptr);
    found.holes.add(set, taped->belts, &taped->holes);
    found.both.add(set, both->belts, &both->holes);
    found.bent += both->holes.displacement ? 1 : 0;
  }
  std::cout << "tool, anchors, mm: belts alone " << rms(found.belts.tool_mm) << ", "
            << rms(found.belts.anchors_mm) << "; holes alone " << rms(found.holes.tool_mm) << ", "
            << rms(found.holes.anchors_mm) << "; both " << rms(found.both.tool_mm) << ", "
            << rms(found.both.anchors_mm) << "; bent " << found.bent << "\n";
  return found;
}

TEST(BeltsAndHoles, TogetherTheyBeatEither) {
  // A few holes, and a tape held by one person.
  const Compared found = compared({.tape_mm = 1.0, .few_holes = true}, 40);
  // Belts do not determine the scale: 0.4 % of some 650 mm, the mean distance from the centre.
  EXPECT_GT(rms(found.belts.tool_mm), 2.0);
  // Several times the standard error of the rms over forty machines, which is a ninth.
  EXPECT_LT(rms(found.both.tool_mm), 0.7 * rms(found.holes.tool_mm));
  EXPECT_LT(rms(found.both.tool_mm), 0.4 * rms(found.belts.tool_mm));
  EXPECT_LT(rms(found.both.anchors_mm), 0.5 * rms(found.holes.anchors_mm));
  EXPECT_LT(rms(found.both.anchors_mm), 0.5 * rms(found.belts.anchors_mm));
}

TEST(BeltsAndHoles, WhatHangsBesideItsBeltsIsInTheMap) {
  const Compared straight = compared({}, 20);
  const Compared bent = compared({.unmodelled_mm = 4.0}, 20);
  // A displacement needs odds of twenty to one: one machine in twenty shows a false one.
  EXPECT_LE(straight.bent, 3);
  EXPECT_GE(bent.bent, 17);
  EXPECT_LT(rms(bent.both.tool_mm), 0.5 * rms(bent.belts.tool_mm));
}

TEST(BeltsAndHoles, SigmasAreWhatTheTruthIsOffBy) {
  constexpr int kMachines = 60;
  double square = 0.0;
  for (int k = 0; k < kMachines; ++k) {
    const SimulatedHoles set =
        simulate_with_holes({.seed = 500 + static_cast<std::uint64_t>(k), .few_holes = true});
    const auto fit = fit_belts_and_holes(set.belts, {set.holes});
    ASSERT_TRUE(fit) << "seed " << 500 + k;
    square += std::pow((fit->belts.scale->factor - set.scale) / fit->belts.scale->sigma, 2);
  }
  // The mean of sixty squares has a sigma of 0.18; three of these.
  EXPECT_NEAR(square / kMachines, 1.0, 0.55);
}

TEST(BeltsAndHoles, ADistanceReadWronglyIsSetAsideByItsEnds) {
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

TEST(BeltsAndHoles, TheSheetsEdgesLayTheFrame) {
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
  // Half a millimetre of the sheet's size, which readings to its edges include.
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
