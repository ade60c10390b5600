// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far from where it is sent a machine puts the tool, over the measured area: as it is used today,
/// with other numbers typed in, or with a map. One definition for all of them:
///
///   e(p) = J(p)^-1 (paid_out(p) - map(p)) + S(p) z                                          (1)
///
/// where the tool lands minus where it was sent. The first part is what the map says of a controller,
/// to first order: where the tool is a millimetre off, it is wrong by 1 um. The second is what is
/// uncertain of the map itself (length_map.hpp).
///
///   rms      root of the mean over the area of E|e|^2
///   largest  what max |e| over the area, its edge included, does not exceed in 95 of 100 sessions
///            (largest_error.hpp)
///
/// Notation
///   p  a place                            paid_out  the lengths that a controller pays out for it
///   J  d(left, right)/d(p) of the map     S, z      what is uncertain of the tool, and normal numbers
///
/// \code
///   if (const auto error = error_in_use(map)) say(error->rms_mm, error->maximum_mm);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "grid/map/map_in_frame.hpp"

namespace chaintrue::grid {

/// A place of the measured area as the map has it.
struct MeasuredPlace {
  model::BedPoint commanded;
  model::ChainLengths lengths;
  /// J^-1 of (1).
  Eigen::Matrix2d to_tool;
  /// S of (1).
  Eigen::Matrix2Xd spread_mm;
  bool is_on_edge = false;
};

/// Within a convex hull 25 columns and 13 rows, closer than any wave of a map between a few dozen
/// points, and its edge at the same spacing. Places that the map does not answer are left out.
[[nodiscard]] std::vector<MeasuredPlace> measured_places(const LengthMap& map,
                                                         const std::vector<model::BedPoint>& hull);
/// `frame` says what the controller is sent by: the numbers of the marks, or places on the bed.
[[nodiscard]] std::vector<MeasuredPlace> measured_places(const CompensationMap& map, MapFrame frame);

/// What a controller pays out for a command; nothing where it cannot go there.
using PaidOut = std::function<std::optional<model::ChainLengths>(model::BedPoint)>;
[[nodiscard]] PaidOut paid_out_by(const model::Machine& machine);

/// The first part of (1) at every place, x and y one below the other; nothing where the controller
/// cannot go to one.
[[nodiscard]] std::optional<Eigen::VectorXd> controller_errors(const PaidOut& paid_out,
                                                               const std::vector<MeasuredPlace>& places);

/// Of (1) with such a first part. \pre There is a place within the hull.
[[nodiscard]] ErrorSummary summary_of_errors(const std::vector<MeasuredPlace>& places,
                                             const Eigen::VectorXd& errors_mm);

/// How far the machine misses as it is used today: the controller with its settings in force is sent
/// to the marks' numbers, the sheet lying where it lay. Nothing of a map without a machine, of an
/// ideal controller whose machine a diagnosis has extended, or where the controller cannot go to a
/// measured place.
[[nodiscard]] std::optional<ErrorSummary> error_in_use(const CompensationMap& map);

/// Says of the map what (1) is where the tool is sent by the map itself.
void measure_expected_error(const CompensationMap& map, MapAccuracy& accuracy);

}  // namespace chaintrue::grid
