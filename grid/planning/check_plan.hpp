// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The few points that are best for checking, a month later, whether a map is still valid.
///
/// The causes that are hardest to distinguish are a chain whose links grew and a chain whose zero
/// shifted: over most of the bed both shorten its readings by about the same amount. The points are
/// those where they differ most. With K, X and P of map_check.hpp, x the change of the readings by
/// growth of one chain by kPitchGrowthSigma and Z that by shifted zeros,
///
///   expected^2 = x' (K + Z P Z')^-1 x                                                           (1)
///
/// is the squared significance of growth, in sigmas, after projection on the shifted zeros. The
/// harmonic mean over both chains is maximised by exchanging points of a lattice. Source: A.
/// Atkinson, A. Donev and R. Tobias, Optimum Experimental Designs, with SAS (2007), section 12.3,
/// for the exchange.
///
/// \code
///   const auto plan = plan_check(map, {.points = 5});
///   if (plan) for (const MarkPoint& mark : plan->marks) visit(mark);
/// \endcode
#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "grid/planning/measurement_plan.hpp"

namespace chaintrue::grid {

inline constexpr int kFewestCheckPoints = 3;
inline constexpr int kMostCheckPoints = 12;

struct CheckPlanRequest {
  int points = 5;
  /// For a reading and for a mark, one sigma.
  double length_mm = 0.3;
  double position_mm = 0.0;
  /// From the bed's edge to the outermost marks.
  double margin_mm = 10.0;
};

struct CheckPlan {
  /// In whole mm, row by row from the top left.
  std::vector<MarkPoint> marks;
  /// (1) of either chain.
  PerSide<double> expected_sigmas;
};

/// (1) for given points; the request's number of points and margin are ignored. Fails with a
/// message if the map has no answer at one of them.
[[nodiscard]] tl::expected<PerSide<double>, PlanFailure> expected_sigmas(
    const CompensationMap& map, const std::vector<MarkPoint>& marks,
    const CheckPlanRequest& request);

/// Fails with a message if the map has no machine, or answers at too few positions. \throws
/// std::invalid_argument for numbers out of range.
[[nodiscard]] tl::expected<CheckPlan, PlanFailure> plan_check(const CompensationMap& map,
                                                              const CheckPlanRequest& request);

}  // namespace chaintrue::grid
