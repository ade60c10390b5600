// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The best settings for a controller that models chains as straight lines: FluidNC's WallPlotter
/// and grblHAL's wall plotter.
///
///   paid(p) = map(p0) + c (|p - a| - |p0 - a|)                                              (1)
///
/// for each chain, with its anchor a and the factor c of its count, if the machine is switched on
/// with the tool at p0, 0, 0 of the sheet. Least squares of the tool's error (controller_error.hpp)
/// over the measured part, by Gauss and Newton. grblHAL takes its anchors as level.
///
/// Sources: bdring/FluidNC, Kinematics/WallPlotter.cpp; grblHAL/core, kinematics/wall_plotter.c.
///
/// \code
///   const auto nearest = straight_settings(map, Anchors::level);
///   if (nearest) say(nearest->anchors.left, nearest->left_over.rms_mm);
/// \endcode
#pragma once

#include <tl/expected.hpp>

#include "grid/map/compensation_map.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

/// Whether both anchors must have the same height.
enum class Anchors { free, level };

struct StraightSettings {
  /// In the coordinates of the sheet, y up.
  PerSide<BedPoint> anchors;
  /// c of (1): factor from the steps per millimetre of a correctly counted chain to those to set.
  PerSide<double> more_steps;
  /// The straight distance from 0, 0 minus the map's length there, mm.
  ChainLengths longer_mm;
  /// For the tool, over the measured part.
  ErrorSummary left_over;
};

enum class StraightReason {
  no_machine,  ///< a map of splines through the lengths
  no_origin,   ///< the map has no answer at 0, 0
  not_converged,
};
std::string_view sentence_of(StraightReason reason);
using StraightFailure = Failure<StraightReason>;

[[nodiscard]] tl::expected<StraightSettings, StraightFailure> straight_settings(
    const CompensationMap& map, Anchors anchors);

}  // namespace chaintrue::grid
