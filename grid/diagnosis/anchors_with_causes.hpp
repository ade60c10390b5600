// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The anchors of a router on four belts, with sigmas that allow for the stretch of pulled
/// belts and every other cause in the belts' table at its usual size (belts_analysis.hpp). A
/// diagnosis of the same belts reports the same anchors.
///
/// With P and P_t the precision of anchors and scale by corrected readings, without and with the
/// taped distances, x and x_t where either has its minimum, and C, a the averaged anchors:
///
///   Q = C^-1 + P_t - P,   x_all = Q^-1 (C^-1 a + P_t x_t - P x)                             (1)
///
/// \code
///   const auto fit = fit_with_causes(belts);
///   if (fit) use(fit->coordinates[0].sigma_mm, fit->causes);
/// \endcode
#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/belts/belts_fit.hpp"

namespace chaintrue::grid::diagnosis {

/// Fails with a sentence where fit_belts() fails.
[[nodiscard]] tl::expected<BeltsFit, BeltsFitFailure> fit_with_causes(const MeasuredBelts& belts);

/// With holes that were cut and taped; belts without points have the anchors that their machine
/// states.
/// \throws std::invalid_argument as fit_belts_and_holes() does.
[[nodiscard]] tl::expected<BeltsAndHolesFit, BeltsFitFailure> fit_with_causes_and_holes(
    const MeasuredBelts& belts, const std::vector<BeltHoles>& sets);

}  // namespace chaintrue::grid::diagnosis
