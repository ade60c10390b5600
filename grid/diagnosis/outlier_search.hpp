// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sets of readings that some hypothesis would rather do without, by mean shifts: each group of rows'
/// directions that one slip spoils has a shift of its own, the groups are added one after the other,
/// and the best of the nested sets by its evidence counts.
///
/// Notation, in addition to evidence.hpp
///   P    precision of the kept rows, sizes of regressors and shifts so far unknown
///   u    P times the residual
///   D    directions of a group among its rows, orthonormal
///
///   drop = u' D (D' P D)^-1 D' u,   log |V| grows by log |D' P D|                             (1)
///
/// Source: R. Cook and S. Weisberg, Residuals and Influence in Regression (1982), section 2.2.2,
/// for the mean-shift model.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "grid/diagnosis/evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Readings that one slip spoils together, as a direction of one or two consecutive rows. Groups of
/// the same rows follow one another.
struct OutlierGroup {
  Eigen::Index first_row = 0;
  Eigen::Index rows = 1;
  /// Among two rows, of any length but zero; absent: all rows.
  std::optional<Eigen::Vector2d> direction{};
};

/// The rows of each unit: a point read wrongly spoils both.
[[nodiscard]] std::vector<OutlierGroup> unit_groups(const RegressorSystem& system);

/// Where the search ends, besides kMostOutlierShare of the groups.
struct OutlierLimits {
  std::size_t fewest_groups = 0;  ///< so many stay
  Eigen::Index fewest_rows = 0;   ///< so many stay
  /// Of groups beyond the best set so far: several bad ones can hide one another.
  std::size_t beyond_the_best = std::numeric_limits<std::size_t>::max();
};

/// A flag a group, the most probable set first; groups of units that are excluded beforehand are
/// flagged in all of them. Where a set takes all directions of some rows, all groups of these rows
/// are flagged. `hypotheses` are sets of regressors.
[[nodiscard]] std::vector<std::vector<bool>> outlier_sets(
    const RegressorSystem& system,
    const std::vector<OutlierGroup>& groups,
    const OutlierLimits& limits,
    const std::vector<bool>& excluded,
    const std::vector<std::vector<int>>& hypotheses,
    const Steps& steps);

/// The same of units.
[[nodiscard]] std::vector<std::vector<bool>> outlier_sets(
    const RegressorSystem& system,
    const std::vector<bool>& excluded,
    const std::vector<std::vector<int>>& hypotheses,
    const Steps& steps);

}  // namespace chaintrue::grid::diagnosis
