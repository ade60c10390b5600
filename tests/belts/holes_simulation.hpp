// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Simulated lengths and holes of a router on four belts with wrong stated anchors, belts that are
/// longer per turn than stated, and a tool displaced from its upper belts: for tests, with
/// independent formulas.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/belts/belts_and_holes.hpp"

namespace chaintrue::grid {

struct HolesSimulation {
  std::uint64_t seed = 1;
  int columns = 6;
  int rows = 6;
  double belt_noise_mm = 0.5;
  /// True millimetres over those that the belts count.
  double scale = 1.004;
  /// Largest displacement of the tool from its upper belts, mm; 0: none.
  double unmodelled_mm = 0.0;
  double tape_mm = 0.5;
  double hole_mm = 0.3;
  /// Five holes and their ten distances instead of nine and 24.
  bool few_holes = false;
  /// Sigma of the stated anchors' error.
  double stated_off_mm = 20.0;
};

struct SimulatedHoles {
  MeasuredBelts belts;
  BeltHoles holes;
  model::BeltMachine truth;  ///< in the belts' own millimetres
  double scale = 1.0;
  double unmodelled_mm = 0.0;
  /// The tool's true position in the true frame, mm, for these horizontal spans of the upper belts,
  /// in the belts' own millimetres.
  model::BedPoint tool(double left_mm, double right_mm) const;
};

[[nodiscard]] SimulatedHoles simulate_with_holes(const HolesSimulation& simulation);

/// Rms of the differences after the best-fit placement of the first points on the others.
double rms_when_laid(const std::vector<model::BedPoint>& from,
                     const std::vector<model::BedPoint>& to);

}  // namespace chaintrue::grid
