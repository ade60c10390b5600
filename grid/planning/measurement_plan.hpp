// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where to measure a machine with so many points, and how good the map from them will be.
///
/// The points stand on columns and rows with Chebyshev-Lobatto spacing, denser towards the edges,
/// where a surface errs most. Points that make no further row or column go, one after the other,
/// where the map from the others is expected to err most.
///
/// The expected error is that of a map fitted to simulated readings of the stated machine with a
/// smooth disturbance that it does not have, so that the surface has something to bend for; the
/// readings are free of noise, but the fit takes them for as noisy as stated.
///
/// \code
///   const auto plan = plan_measurement(machine, {.points = 28});
///   if (plan) for (const MarkPoint& mark : plan->marks) visit(mark);
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "grid/observation/chain_lengths.hpp"

namespace chaintrue::grid {

/// Fewest and most points that a plan may have.
inline constexpr int kFewestPlanned = 12;
inline constexpr int kMostPlanned = 200;
/// Marks and holes are planned on no less than so much by so much, the margin left out.
inline constexpr double kLeastPlannedSideMm = 100.0;

struct PlanRequest {
  int points = 28;
  /// From the bed's edge to the outermost marks: a mark at the very edge cannot be drawn.
  double margin_mm = 10.0;
  /// Of a reading, one sigma.
  observation::PointNoise noise = {};
};

struct MeasurementPlan {
  /// In whole mm, in walking order: row by row from the bottom, turning round at the end of each.
  std::vector<model::MarkPoint> marks;
  int columns = 0;
  int rows = 0;
  /// Points beyond columns * rows.
  int extra = 0;
  /// Of the simulated readings at the marks; its sigmas are the expected errors.
  CompensationMap map;
};

/// Why there is no plan, with the place.
struct PlanFailure {
  enum class Reason {
    no_machine,
    unreachable,     ///< a mark where the machine cannot hold the sled, or off the map
    too_few_places,  ///< that could be measured or cut at all
    no_map,          ///< what would be measured makes no map
  } reason;
  std::string sentence;
};

/// \throws std::invalid_argument for a number of points out of range, or a margin that leaves no
/// bed.
[[nodiscard]] tl::expected<MeasurementPlan, PlanFailure> plan_measurement(
    const model::Machine& machine, const PlanRequest& request);

/// One sigma of the tool over a raster of the whole bed, row by row from the bottom left, at the
/// middles of columns x rows equal cells; negative where the map has no answer.
[[nodiscard]] std::vector<double> expected_error_mm(const CompensationMap& map,
                                                    const model::Bed& bed,
                                                    int columns,
                                                    int rows);

}  // namespace chaintrue::grid
