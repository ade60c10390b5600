// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A set of measurements: marks on the bed, the chain lengths read there, and their noise.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/machine.hpp"

namespace chaintrue::grid {

struct MeasuredPoint {
  /// Where the tool stood, in the marks' frame (the bed's, unless the sheet was placed by hand).
  MarkPoint mark;
  /// Absent if the point gives a command instead.
  std::optional<ChainLengths> lengths;
  std::optional<BedPoint> commanded;
  /// Number of the visit; all points have it, distinct, or none.
  std::optional<int> order;
};

/// One sigma as stated, and the degrees of freedom of the estimate.
struct StatedNoise {
  double length_mm = 0.2;
  double position_mm = 0.3;
  double dof = 15.0;
};

/// The marks' frame was placed by hand with these sigmas.
struct SheetUncertainty {
  double shift_mm = 20.0;
  double rotation_mrad = 10.0;
};

/// Readings other than points, in the order of their names, by which they are sorted.
enum class ReadingOf {
  beam_rise,      ///< mm
  chain_mass,     ///< kg per m
  link_pitch,     ///< mm
  motor_spacing,  ///< mm
  ring_radius,    ///< mm
  sled_mass,      ///< kg
  tape_error,     ///< mm per m
};
/// As in files, with its unit: "beam_rise_mm".
std::string_view name(ReadingOf what);

struct ExtraReading {
  ReadingOf what = ReadingOf::motor_spacing;
  std::string side;
  double value = 0.0;
  double sigma = 0.0;
  friend bool operator==(const ExtraReading&, const ExtraReading&) = default;
};

struct MeasuredGrid {
  std::string name;
  std::optional<Machine> machine;
  /// Absent: estimated from repeats, or from the fit's residuals, and reported.
  std::optional<StatedNoise> noise;
  std::optional<SheetUncertainty> sheet;
  std::vector<ExtraReading> readings;
  std::vector<MeasuredPoint> points;
};

}  // namespace chaintrue::grid
