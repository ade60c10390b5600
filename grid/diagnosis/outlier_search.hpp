// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Finds sets of readings that some hypothesis would reject, by mean shifts: each group of rows'
/// directions that one slip spoils has its own shift, the groups are added one after the
/// other, and the nested set with the best evidence is used.
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

#include <vector>

#include "grid/diagnosis/evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// A flag for each outlier group of the system, the most probable set first; groups of units that
/// are excluded beforehand are flagged in all of them. Where a set takes all directions of some
/// rows, all groups of these rows are flagged. `hypotheses` are sets of regressors.
std::vector<Flags> outlier_sets(const RegressorSystem& system, const Flags& excluded,
                                const std::vector<RegressorSet>& hypotheses);

}  // namespace chaintrue::grid::diagnosis
