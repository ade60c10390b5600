// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The error of the tool over the measured area: with the settings in force, with others typed in,
/// or with a map. All use one definition:
///
///   e(p) = J(p)^-1 (paid_out(p) - map(p)) + S(p) z                                          (1)
///
/// where the tool lands minus where it was sent. The first part is a controller's error by the map,
/// to first order: 1 um off for an error of a millimetre. The second is the map's uncertainty
/// (length_map.hpp).
///
///   rms      root of the mean over the area of E|e|^2
///   largest bound of max |e| over the area and its edge in 95 of 100 sessions
///            (largest_error.hpp)
///
/// Notation
///   p  a place                            paid_out  the lengths that a controller pays out for it
///   J  d(left, right)/d(p) of the map     S, z      the tool's uncertainty, and normal numbers
///
/// \code
///   if (const auto error = error_in_use(map)) say(error->rms_mm, error->maximum_mm);
/// \endcode
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "grid/map/map_in_frame.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// A place of the measured area on the map.
struct MeasuredPlace {
  BedPoint commanded;
  ChainLengths lengths;
  /// J^-1 of (1).
  Matrix2d to_tool;
  /// S of (1).
  Matrix2Xd spread_mm;
  bool is_on_edge = false;
};

/// Within a convex hull 25 columns and 13 rows, closer than any wave of a map between a few dozen
/// points, and its edge at the same spacing. Places that the map does not answer are left out.
std::vector<MeasuredPlace> measured_places(const LengthMap& map, const std::vector<BedPoint>& hull);
/// `frame` states what the controller's commands refer to: the numbers of the marks, or places on
/// the bed.
std::vector<MeasuredPlace> measured_places(const CompensationMap& map, MapFrame frame);

/// The lengths that a controller pays out for a command; empty if it cannot go there.
using PaidOut = std::function<std::optional<ChainLengths>(BedPoint)>;
PaidOut paid_out_by(const Machine& machine);

/// The first part of (1) at every place, x and y one below the other; empty if the controller
/// cannot go to one.
std::optional<VectorXd> controller_errors(const PaidOut& paid_out,
                                          const std::vector<MeasuredPlace>& places);

/// For (1) with such a first part. \pre There is a place within the hull.
ErrorSummary summary_of_errors(const std::vector<MeasuredPlace>& places, const VectorXd& errors_mm);

/// The machine's error as used today: the controller with its settings in force is sent to the
/// marks' numbers, the sheet being where it was. Empty for a map without a machine, for an ideal
/// controller whose machine a diagnosis has extended, or if the controller cannot go to a measured
/// place.
std::optional<ErrorSummary> error_in_use(const CompensationMap& map);

/// Adds to the map's statements (1) for a tool sent by the map.
void measure_expected_error(const CompensationMap& map, MapAccuracy& accuracy);

}  // namespace chaintrue::grid
