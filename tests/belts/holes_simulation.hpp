// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A router on four belts that measures its lengths and cuts holes, with anchors that are not where
/// they are stated, belts that are longer a turn than they are said to be, and a tool that hangs
/// beside its upper belts: for tests, with formulas of its own.
#pragma once

#include <cstdint>
#include <functional>
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
  /// Of where the tool lies beside its upper belts, mm; 0: nowhere.
  double beside_mm = 0.0;
  double tape_mm = 0.5;
  double hole_mm = 0.3;
  /// Five holes and their ten distances in place of nine and 24.
  bool few_holes = false;
  /// One sigma of how far the stated anchors are off.
  double stated_off_mm = 20.0;
};

struct SimulatedHoles {
  MeasuredBelts belts;
  BeltHoles holes;
  model::BeltMachine truth;  ///< in the belts' own millimetres
  double scale = 1.0;
  double beside_mm = 0.0;
  /// Where the tool stands, true millimetres in the true frame, with these level spans of the upper
  /// belts, counted by the belts.
  [[nodiscard]] model::BedPoint tool(double left_mm, double right_mm) const;
};

[[nodiscard]] SimulatedHoles simulate_with_holes(const HolesSimulation& simulation);

/// Rms of what is left when the first points are laid on the others as a whole.
[[nodiscard]] double rms_when_laid(const std::vector<model::BedPoint>& from,
                                   const std::vector<model::BedPoint>& to);

}  // namespace chaintrue::grid
