// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Simulated belt lengths with known anchors and positions, for tests: the product's own kinematics
/// and normal noise.
#pragma once

#include <cstdint>

#include "grid/belts/anchor_fit.hpp"
#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid {

struct SimulatedBelts {
  MeasuredBelts belts;  ///< with the stated machine
  model::BeltMachine truth;
  std::vector<model::FramePoint> places;
};

struct BeltSimulation {
  std::uint64_t seed = 1;
  int columns = 9;
  int rows = 9;
  double noise_mm = 0.5;
  /// Sigma of the stated anchors' error.
  double stated_off_mm = 20.0;
  bool anchors_known = true;
  model::BeltLengths lengths = model::BeltLengths::span;
};

/// Positions over the middle of a frame of 2.4 to 3.6 by 1.8 to 2.6 m, visited row by row in
/// alternating directions.
SimulatedBelts simulate(const BeltSimulation& simulation);
/// Readings at points 3 (tl), 30 and 31 (br) and 60 (tr) are wrong.
[[nodiscard]] SimulatedBelts with_four_bad_readings(std::uint64_t seed);

}  // namespace chaintrue::grid
