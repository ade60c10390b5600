// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A simulated session of a router on four belts that finds its anchors, with hidden effects: commands
/// are converted to belt lengths with the stated anchors, the upper belts' true anchors give the
/// tool's position, and all four lengths are read.
///
/// \code
///   BeltsSpec spec;
///   spec.hidden = {{"belt_stretch", "", {{"elongation", 0.004}}}};
///   const auto made = simulate_belts(stated, truth, spec);   // made->points, with commands and order
/// \endcode
#pragma once

#include <cstdint>
#include <tl/expected.hpp>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::synthetic {

struct BeltsSpec {
  int columns = 9;
  int rows = 9;
  /// Share of the frame's width and height, about its centre.
  double width_share = 0.5;
  double height_share = 0.4;
  double noise_mm = 0.5;  ///< one sigma of a belt's reading
  bool heavy_tails = false;
  double rounding_mm = 0.0;   ///< readings are whole multiples; 0: not rounded
  int bad_readings = 0;       ///< number of readings of one belt with a gross error
  double bad_size_mm = 44.0;  ///< its size, of either sign
  /// All places once with each of these pulls, relative; sizes of effects are those at the least.
  /// Empty: once, without a stated pull.
  std::vector<double> pulls{};
  std::vector<AppliedEffect> hidden{};
  std::uint64_t seed = 1;
};

/// Its place is the command.
using BeltsUnreachable = Failure<model::BeltReason, BedPoint>;

/// Rows from below, there and back. \throws std::logic_error for anchors that are not known, effects
/// with problems (model::effects::problems_in), fewer than two columns or rows, or more bad readings
/// than there are points.
[[nodiscard]] tl::expected<MeasuredBelts, BeltsUnreachable> simulate_belts(
    const BeltMachine& stated, const BeltMachine& truth, const BeltsSpec& spec);

}  // namespace chaintrue::grid::synthetic
