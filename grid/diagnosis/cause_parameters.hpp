// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Size and place of a cause, each with one sigma. Private to grid/diagnosis.
///
/// A place's sigma is the larger of two: the scatter of the place over the models, and the curvature of the
/// likelihood about the best, settings and all other coefficients free. For a step between two
/// marks it is that of a uniform distribution over the gap.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// The cause of regressor `column`, in the effect's order. \pre `fitted` has the regressor.
[[nodiscard]] std::vector<ParameterEstimate> parameters_of(const Analysis& analysis,
                                                           int column,
                                                           const Estimate& fitted);

/// Index of a regressor among those of a fit.
[[nodiscard]] Eigen::Index position_of(const Estimate& fitted, int column);

}  // namespace chaintrue::grid::diagnosis
