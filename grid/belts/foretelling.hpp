// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lower belts as the upper two foretell them, at places that the anchors were not fitted to.
/// Private to grid/belts.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/fit_diagnostics.hpp"

namespace chaintrue::grid::belts {

/// What the lower belts of a point are off by from what the upper ones foretell; nothing where a belt
/// that it takes does not count.
void foretell(const MeasuredBelts& belts,
              std::size_t point,
              const AnchorVector& anchors,
              const model::PerBelt<bool>& counting,
              std::vector<double>& off_mm);
[[nodiscard]] BeltPrediction summed(const std::vector<double>& off_mm);
/// Points in the order of their visits, of the file where that is not known.
[[nodiscard]] std::vector<std::size_t> in_order(const MeasuredBelts& belts);

/// Each place by the anchors without it. Readings that are set aside neither foretell nor are
/// foretold.
[[nodiscard]] BeltPrediction foretell_one_by_one(const MeasuredBelts& belts,
                                                 const FitDiagnostics& view);
/// Every second place, in the order of the visits, by the others, and those by these. Empty where a
/// half has fewer than kFewestBeltPoints, or settles nowhere.
[[nodiscard]] std::optional<BeltPrediction> foretell_by_halves(const MeasuredBelts& belts,
                                                               const AnchorFit& frame);

}  // namespace chaintrue::grid::belts
