// SPDX-License-Identifier: GPL-3.0-or-later
// Belts and holes in one fit, on simulated machines: what either tells alone, and both together.
#include "grid/belts/belts_and_holes.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

#include "grid/belts/belt_map.hpp"
#include "grid/statistics.hpp"
#include "tests/belts/holes_simulation.hpp"

namespace chaintrue::grid {
namespace {

using belts::anchors_of;
using model::BedPoint;

/// Places over the sheet that no hole stands at.
std::vector<BedPoint> targets() {
  std::vector<BedPoint> points;
  for (const double y : {-400.0, -150.0, 200.0, 420.0}) {
    for (const double x : {-900.0, -500.0, -100.0, 350.0, 800.0}) points.push_back({x, y});
  }
  return points;
}

/// The tool's error over the sheet when the map says what the belts must be.
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

struct Errors {
  std::vector<double> belts;
  std::vector<double> holes;
  std::vector<double> both;
};

Errors errors_of(HolesSimulation simulation, int machines) {
  Errors errors;
  for (int k = 0; k < machines; ++k) {
    simulation.seed = 300 + static_cast<std::uint64_t>(k);
    const SimulatedHoles set = simulate_with_holes(simulation);
    const auto alone = fit_belts(set.belts);
    const auto taped = fit_belts_and_holes(without_points(set.belts), {set.holes});
    const auto both = fit_belts_and_holes(set.belts, {set.holes});
    EXPECT_TRUE(alone && taped && both) << "seed " << simulation.seed;
    if (!alone || !taped || !both) continue;
    errors.belts.push_back(error_mm(set, BeltMap(*alone)));
    errors.holes.push_back(error_mm(set, BeltMap(taped->belts, &taped->holes)));
    errors.both.push_back(error_mm(set, BeltMap(both->belts, &both->holes)));
  }
  return errors;
}

TEST(BeltsAndHoles, TogetherTheyBeatEither) {
  const Errors errors = errors_of({}, 20);
  std::cout << "tool, mm: belts alone " << rms(errors.belts) << ", holes alone "
            << rms(errors.holes) << ", both " << rms(errors.both) << "\n";
  // Belts do not know the scale: 0.4 % of some 650 mm, the middle distance from the centre.
  EXPECT_GT(rms(errors.belts), 2.0);
  EXPECT_LT(rms(errors.both), 0.9 * rms(errors.holes));
  EXPECT_LT(rms(errors.both), 0.5 * rms(errors.belts));
}

}  // namespace
}  // namespace chaintrue::grid
