// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The gain of naming: held-out error of the tool with the whole naming repeated in every fold.
/// Blocks of the bed are held out in turn; in each fold models are compared and causes estimated on
/// the remaining points, and the held-out readings are compared with the prediction. Settings and
/// causes are never fitted to held-out points. The surface is the model discrepancy's expectation
/// at the length and size that the fold's points prefer.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/downdating.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

/// The models without some units (positions in the session) and their decision, with the gate and
/// classes of all units.
struct DecidedWithout {
  Downdating::Without models;
  Decision decision;
};
DecidedWithout decided_without(const Analysis& analysis, const Downdating& downdating,
                               const Indices& units);

/// Empty if there are too few points to hold any out.
std::optional<HeldOutImprovement> measure_improvement(const Analysis& analysis);

/// Whether a machine with the causes predicts held-out readings better than one without, with the
/// surface in both: only the comparison of measure_improvement().
bool naming_improves_the_map(const Analysis& analysis);
bool naming_improves_the_map(const std::optional<HeldOutImprovement>& improvement);

/// Root mean square and 95th percentile of tool errors, and the interval of the first over
/// resampled blocks. `block` numbers the block of each error.
HeldOut summarise(const std::vector<Vector2d>& tool_mm, const Indices& block, std::uint64_t seed);

/// The errors of the machine as it was delivered. For a place with a command they are commanded
/// minus measured, regardless of the stated machine. Whitened like `stated.e`; `stated` is the
/// session linearised about the stated values.
VectorXd uncalibrated(const ObservationSet& session, const RegressorSystem& stated);

}  // namespace chaintrue::grid::diagnosis
