// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the leading explanation of an analysis is made of: its columns, and estimates with them.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Column k of the analysis' system.
[[nodiscard]] const Regressor& regressor(const Analysis& analysis, int k);

/// The marginalised system in which the decision was made.
[[nodiscard]] const MarginalisedSystem& marginalised_system(const Analysis& analysis);

/// The most probable column of a cause over the models of the comparison, or that with its best
/// score; -1 where the cause has none.
[[nodiscard]] int best_regressor(const Analysis& analysis, const CauseId& cause);

/// Flags the units whose readings a cause at one visit alone accounts for.
void reject_slips(const Analysis& analysis, std::vector<bool>& outliers);

/// Whether no points tell the two apart.
[[nodiscard]] bool same_class(const Analysis& analysis, const CauseId& x, const CauseId& y);

/// The column most like another of all causes that are neither of its class nor named; -1 where
/// there is none.
struct Nearest {
  int column = -1;
  double collinearity = 0.0;  ///< |cosine| of the two
};
[[nodiscard]] Nearest nearest_other(const Analysis& analysis, int column);

/// What is named, or else leads, and what is most like the first of it: for pictures next to each
/// other.
struct Shown {
  std::vector<int> best;
  std::vector<int> rival;
};
[[nodiscard]] Shown shown(const Analysis& analysis);

/// Estimate with these columns, given the discrepancy where the decision holds one.
[[nodiscard]] Estimate estimate_with(const Analysis& analysis, std::vector<int> columns);

/// Estimate with these columns and no discrepancy.
[[nodiscard]] Estimate estimate_of(const Analysis& analysis, const std::vector<int>& columns);

}  // namespace chaintrue::grid::diagnosis
