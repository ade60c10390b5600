// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/belts/simulated_belts.hpp"

#include "grid/random.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid {

SimulatedBelts simulate(const BeltSimulation& simulation) {
  Random random(simulation.seed);
  SimulatedBelts result;
  model::BeltMachine& truth = result.truth;
  const double width = random.uniform(2400.0, 3600.0);
  const double height = random.uniform(1800.0, 2600.0);
  const auto near = [&](double value) { return value + random.uniform(-60.0, 60.0); };
  truth =
      belts::with_anchors(truth, {near(0.0), near(height), near(width), near(height), near(width)});
  truth.lengths = simulation.lengths;
  result.belts.machine = truth;
  belts::AnchorVector stated = belts::anchors_of(truth);
  for (double& coordinate : stated) coordinate += simulation.stated_off_mm * random.normal();
  if (simulation.anchors_known) {
    result.belts.machine = belts::with_anchors(truth, stated);
  } else {
    result.belts.machine = belts::with_anchors(truth, belts::AnchorVector::Zero());
    result.belts.machine.anchors_known = false;
  }
  int visit = 0;
  for (int row = 0; row < simulation.rows; ++row) {
    for (int i = 0; i < simulation.columns; ++i) {
      const int column = row % 2 == 0 ? i : simulation.columns - 1 - i;
      const model::FramePoint place{
          width * (0.25 + 0.5 * column / (simulation.columns - 1)) + random.uniform(-5.0, 5.0),
          height * (0.3 + 0.4 * row / (simulation.rows - 1)) + random.uniform(-5.0, 5.0)};
      BeltPoint point;
      point.lengths_mm = model::lengths_at(truth, place).value();
      for (const model::Belt belt : model::kBelts) {
        point.lengths_mm[belt] += simulation.noise_mm * random.normal();
      }
      point.order = visit++;
      result.places.push_back(place);
      result.belts.points.push_back(std::move(point));
    }
  }
  return result;
}

SimulatedBelts with_four_bad_readings(std::uint64_t seed) {
  SimulatedBelts set = simulate({.seed = seed});
  set.belts.points[3].lengths_mm.tl += 44.0;
  set.belts.points[30].lengths_mm.br -= 44.0;
  set.belts.points[31].lengths_mm.br -= 12.0;
  set.belts.points[60].lengths_mm.tr += 150.0;
  return set;
}

}  // namespace chaintrue::grid
