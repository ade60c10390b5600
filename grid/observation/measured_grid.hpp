// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a person measured: marks on the bed, the chain lengths read there, and how well.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/machine.hpp"

namespace chaintrue::grid {

struct MeasuredPoint {
  /// Where the tool stood, in the marks' frame (the bed's, unless the sheet was placed by hand).
  model::MarkPoint mark;
  /// Absent where the point gives a command instead.
  std::optional<model::ChainLengths> lengths;
  std::optional<model::BedPoint> commanded;
  /// Number of the visit; all points have it, distinct, or none.
  std::optional<int> order;
};

/// One sigma as the person states it, and how well it is known (degrees of freedom of the estimate).
struct StatedNoise {
  double length_mm = 0.2;
  double position_mm = 0.3;
  double dof = 15.0;
};

/// The marks' frame was placed by hand, this well (one sigma).
struct SheetUncertainty {
  double shift_mm = 20.0;
  double rotation_mrad = 10.0;
};

/// A measurement that is not a point: motor_spacing_mm, beam_rise_mm, ring_radius_mm, sled_mass_kg, link_pitch_mm,
/// chain_mass_kg_per_m.
struct ExtraReading {
  std::string what;
  std::string side;
  double value = 0.0;
  double sigma = 0.0;
  friend bool operator==(const ExtraReading&, const ExtraReading&) = default;
};

struct MeasuredGrid {
  std::string name;
  std::optional<model::Machine> machine;
  /// Absent: estimated from repeats, or from the fit's residuals, and said so.
  std::optional<StatedNoise> noise;
  std::optional<SheetUncertainty> sheet;
  std::vector<ExtraReading> readings;
  std::vector<MeasuredPoint> points;
};

}  // namespace chaintrue::grid
