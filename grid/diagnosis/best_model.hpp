// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The leading explanation of an analysis: its columns, and estimates with them.
#pragma once

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Column k of the analysis' system.
const Regressor& regressor(const Analysis& analysis, int k);

/// The marginalised system in which the decision was made.
const MarginalisedSystem& marginalised_system(const Analysis& analysis);

/// The most probable column of a cause over the comparison's models, or its best-scoring one; -1 if
/// it has none.
int best_regressor(const Analysis& analysis, const CauseId& cause);

/// Flags the units whose readings are explained only by a cause at one visit.
void reject_slips(const Analysis& analysis, Flags& outliers);

/// Whether no points distinguish the two.
bool same_class(const Analysis& analysis, const CauseId& x, const CauseId& y);

/// The column most similar to another, among causes that are neither of its class nor named; -1 if
/// there is none.
struct Nearest {
  int column = -1;
  double collinearity = 0.0;  ///< |cosine| of the two
};
Nearest nearest_other(const Analysis& analysis, int column);

/// The named causes, or else the leading ones, and the cause most similar to the first, for
/// pictures side by side.
struct Shown {
  RegressorSet best;
  RegressorSet rival;
};
Shown shown(const Analysis& analysis);

/// Estimate with these columns, given the decision's discrepancy, if any.
Estimate estimate_with(const Analysis& analysis, RegressorSet columns);

/// Estimate with these columns and no discrepancy.
Estimate estimate_of(const Analysis& analysis, const RegressorSet& columns);

}  // namespace chaintrue::grid::diagnosis
