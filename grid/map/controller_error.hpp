// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far from a map's places a controller puts the tool, over the measured part of the bed:
///
///   e(p) = J(p)^-1 (controller(s, p) - map(p))                                              (1)
///
/// To first order: where the tool is a millimetre off, e is wrong by 1 um.
///
/// Notation
///   p  a place                            s  the settings
///   J  d(left, right)/d(p) of the map     e  mm, x and y
///
/// \code
///   if (const auto error = error_in_use(map)) say(error->rms_mm, error->maximum_mm);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "grid/map/map_in_frame.hpp"

namespace chaintrue::grid {

/// A place of the measured part as the map has it.
struct MeasuredPlace {
  /// What the controller is sent to.
  model::BedPoint commanded;
  model::ChainLengths lengths;
  /// J^-1 of (1).
  Eigen::Matrix2d to_tool;
};

/// 25 x 13 places over an area, row by row: closer than any wave of a map between a few dozen points,
/// and quick.
[[nodiscard]] std::vector<model::BedPoint> raster_over(const interp::Rectangle& area);

/// Of the raster over the bed those that lie between measured points. `frame` says what the
/// controller is sent by: the numbers of the marks, or places on the bed. \pre The map has a machine.
[[nodiscard]] std::vector<MeasuredPlace> measured_places(const CompensationMap& map, MapFrame frame);

/// (1) at every place, x and y one below the other; nothing where the controller cannot go to one.
[[nodiscard]] std::optional<Eigen::VectorXd> controller_errors(
    const model::Machine& machine,
    const model::ControllerSettings& settings,
    const std::vector<MeasuredPlace>& places);

/// Root mean square and largest distance of such errors. \pre There is a place.
[[nodiscard]] ErrorSummary summary_of_errors(const Eigen::VectorXd& errors);

/// How far the machine misses as it is used today: the controller with its settings in force is sent
/// to the marks' numbers, the sheet lying where it lay. Nothing of a map without a machine, or where
/// the controller cannot go to a measured place.
[[nodiscard]] std::optional<ErrorSummary> error_in_use(const CompensationMap& map);

}  // namespace chaintrue::grid
