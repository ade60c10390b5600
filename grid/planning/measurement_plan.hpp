// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chooses where to measure a machine with a given number of points, and predicts the map's
/// accuracy.
///
/// The points are on columns and rows with Chebyshev-Lobatto spacing, denser towards the edges,
/// where the error of a surface is largest. Points beyond the last full row or column are placed
/// one after the other at the largest expected error of the map from the others.
///
/// The expected error is that of a map fitted to simulated readings of the stated machine plus a
/// smooth disturbance, so that the smooth surface is not zero; the readings have no noise, but the
/// fit assumes the stated noise.
///
/// \code
///   const auto plan = plan_measurement(machine, {.points = 28});
///   if (plan) for (const MarkPoint& mark : plan->marks) visit(mark);
/// \endcode
#pragma once

#include <cstddef>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

/// Fewest and most points that a plan may have.
inline constexpr int kFewestPlanned = 12;
inline constexpr int kMostPlanned = 200;
/// Least width and height, without the margin, on which marks and holes are planned.
inline constexpr double kLeastPlannedSideMm = 100.0;

struct PlanRequest {
  int points = 28;
  /// From the bed's edge to the outermost marks: a mark at the very edge cannot be drawn.
  double margin_mm = 10.0;
  /// Noise of a reading, one sigma.
  observation::PointNoise noise = {};
};

struct MeasurementPlan {
  /// In whole mm, in the order of visits: row by row from the bottom, in alternating directions.
  std::vector<MarkPoint> marks;
  int columns = 0;
  int rows = 0;
  /// Points beyond columns * rows.
  int extra = 0;
  /// Fitted to the simulated readings at the marks; its sigmas are the expected errors.
  CompensationMap map;
};

/// Why there is no plan, with the position.
enum class PlanReason {
  no_machine,
  unreachable,     ///< a mark where the machine cannot hold the sled, or off the map
  too_few_places,  ///< too few places that could be measured or cut
  no_map,          ///< no map can be fitted to the planned measurements
};
using PlanFailure = Failure<PlanReason>;

/// \throws std::invalid_argument for a number of points out of range, or a margin that leaves no
/// bed.
[[nodiscard]] tl::expected<MeasurementPlan, PlanFailure> plan_measurement(
    const Machine& machine, const PlanRequest& request);

/// One sigma of the tool over a raster of the whole bed, row by row from the bottom left, at the
/// centres of columns x rows equal cells; negative where the map has no answer.
std::vector<double> expected_error_mm(const CompensationMap& map, const Bed& bed, int columns,
                                      int rows);

// Marks that are visited twice, so that changes during the session show: a zero that moved, drift,
// friction.
//
// The first mark comes again at the very end, so that whatever moved lies between its two visits.
// The others are repeated after equal shares of the session, each a mark of the share before, so
// that their spans divide the session and show when it moved.
//
// \code
//   for (const std::size_t mark : with_second_visits(plan.marks.size(), 4)) drive_to(plan.marks[mark]);
// \endcode

/// Number of second visits in an owner's list.
inline constexpr std::size_t kUsualSecondVisits = 4;

/// Numbers of the marks in the order of the visits: each of `marks` once, in order, and `second` of
/// them again. The two visits of a mark are never consecutive.
/// \throws std::invalid_argument for fewer than three marks a second visit.
[[nodiscard]] Indices with_second_visits(std::size_t marks, std::size_t second);

}  // namespace chaintrue::grid
