// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What naming gains: held-out error of the tool with the whole naming repeated in every fold.
///
/// Blocks of the bed are held out one after the other; in each fold the models are compared anew on
/// the points that stay, whatever it names there is estimated there, and the held-out readings are
/// compared with what it predicts. Settings and causes are never fitted to held-out points. The
/// surface is the model discrepancy's expectation at the length and size that the fold's points
/// prefer.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {

/// Empty where there are too few points to hold any out.
[[nodiscard]] std::optional<HeldOutImprovement> measure_improvement(const Analysis& analysis);

/// Whether a machine with the causes, the surface in both, predicts what is held out better than one
/// without: the comparison of measure_improvement() alone.
[[nodiscard]] bool naming_improves_the_map(const Analysis& analysis);

/// Root mean square and 95th percentile of tool errors, and the interval of the first over blocks
/// drawn anew. `block` numbers the block of each error.
[[nodiscard]] HeldOut summarise(const std::vector<Eigen::Vector2d>& tool_mm,
                                const std::vector<std::size_t>& block,
                                std::uint64_t seed);

/// The errors of the machine as it was delivered. Of a place that gives a command they are what was
/// commanded less what was measured, whatever the stated machine makes of the lengths that its
/// controller paid out. As `stated.e`, whitened; `stated` is the session's linearised where everything is as stated.
[[nodiscard]] Eigen::VectorXd uncalibrated(const ObservationSet& session,
                                           const RegressorSystem& stated);

}  // namespace chaintrue::grid::diagnosis
