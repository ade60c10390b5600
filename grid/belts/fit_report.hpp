// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A BeltsFit from anchors, places and what is known of them. Private to grid/belts and what reads its
/// fits.
#pragma once

#include <Eigen/Core>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/fit_diagnostics.hpp"

namespace chaintrue::grid::belts {

/// Everything but what either half of the places predicts of the other. `belts` and `view` are of the
/// same readings; `covariance` is that of the anchors, mm^2, with a tape of the scale's logarithm too.
[[nodiscard]] BeltsFit fit_report(const MeasuredBelts& belts,
                                  const FitDiagnostics& view,
                                  const Eigen::MatrixXd& covariance);

}  // namespace chaintrue::grid::belts
