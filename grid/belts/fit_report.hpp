// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Assembles a BeltsFit from anchors, places and their covariances, with the error of predicting
/// the lower belts from the upper two at left-out places. Private to grid/belts and what reads its
/// fits.
#pragma once

#include <functional>
#include <optional>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/eigen.hpp"

namespace chaintrue::grid::belts {

/// Everything except the predictions of each half of the places by the other. `belts` and `view`
/// use the same readings; `covariance` is that of the anchors, mm^2, with a tape of the scale's
/// logarithm too.
BeltsFit fit_report(const MeasuredBelts& belts, const FitDiagnostics& view,
                    const MatrixXd& covariance);

/// A fit with what counts given, and the readings as its anchors explain them.
struct Refitted {
  AnchorFit frame;
  MeasuredBelts belts;
};
using Refit = std::function<std::optional<Refitted>(const AnchorFit& from)>;
/// Every second place, in the order of the visits, by the others, and those by these. Empty if a
/// half has fewer than kFewestBeltPoints, or has no fit.
std::optional<BeltPrediction> predict_by_halves(const MeasuredBelts& belts, const AnchorFit& frame,
                                                const Refit& refit);

}  // namespace chaintrue::grid::belts
