// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What naming gains, as expected from the points at hand: no noise of held-out points blurs it.
#pragma once

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

struct ExpectedImprovement {
  /// By how much the mean square of the tool's error falls. The causes' estimate is the mean of
  /// what the truth may be, so the mean square of what naming moves the tool by is the expected
  /// drop.
  double drop_mm2 = 0.0;
  /// Of the mean square before it: what remains is the doubt about settings and sizes.
  double share = 0.0;
};

/// Over the measured area, all places with one weight; of distances those that were read; at the points
/// themselves where a cause depends on the visits.
[[nodiscard]] ExpectedImprovement expected_improvement(const Analysis& analysis);

/// The marginalised system of the decision with the points set aside that causes at one visit alone
/// account for: whoever calibrates without these causes still sees that the points are out.
[[nodiscard]] MarginalisedSystem without_slips(const Analysis& analysis,
                                               const MarginalisedSystem& marginalised);

}  // namespace chaintrue::grid::diagnosis
