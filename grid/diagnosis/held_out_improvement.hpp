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

#include <optional>

#include "grid/diagnosis/analysis.hpp"

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

}  // namespace chaintrue::grid::diagnosis
