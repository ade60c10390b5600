// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The expected gain of naming, without the noise of held-out points.
#pragma once

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

struct ExpectedImprovement {
  /// The reduction of the tool's mean square error. The causes' estimate is the posterior mean, so
  /// the mean square shift of the tool by naming is the expected reduction.
  double drop_mm2 = 0.0;
  /// Share of the mean square before; the rest is the uncertainty of settings and sizes.
  double share = 0.0;
};

/// Over the measured area with equal weights; over the measured distances; or at the points
/// themselves if a cause depends on the visits.
[[nodiscard]] ExpectedImprovement expected_improvement(const Analysis& analysis);

/// The decision's marginalised system without the points that only causes at one visit explain: a
/// calibration without these causes would reject them too.
[[nodiscard]] MarginalisedSystem without_slips(const Analysis& analysis,
                                               const MarginalisedSystem& marginalised);

}  // namespace chaintrue::grid::diagnosis
