// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Grids and sets of holes of one machine, one file or any number of any mix, in one joint estimate
/// and one map: the machine, its chains' scales and the residual surface are estimated from all of
/// them.
///
/// The map's frame is that of the first file's marks; every other file has its own sheet, whose
/// placement is estimated and belongs to it alone. A chain's zero may have been reset between two
/// grids: each but the first has separate zeros. The map's zeros are those of the first grid, so
/// give the most recent one first. A hole is where its chain lengths put it, so each set's
/// controller determines what was paid out. Each file keeps its own stated noise; one factor over
/// all of them is found, known by the fewest degrees of freedom that any of them states. For a grid
/// without stated noise it is estimated from its points first. Readings of the machine count from
/// every file.
///
/// \code
///   const auto fit = joint_fit({{"grid.json", grid}, {"holes.json", holes}});   // or one of them
///   if (fit) write(fit->map);
/// \endcode
#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/map/fitted_points.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::grid {

struct JointFitOptions {
  /// The map's continuation beyond the points.
  OutsideRule outside{};
  Progress progress{};
};

struct JointFit {
  estimation::Estimate estimate;           ///< its observations in the order of the files
  std::vector<FittedPoint> points;         ///< of the files that are grids, in their order
  std::vector<FittedDistances> distances;  ///< of the files that are sets of holes
  CompensationMap map;
};

/// Fails if a file has no machine or different settings from the first, or if a third of a file's
/// readings contradict the others. The machine's effects of the paper and of the visit are removed
/// from grids first (corrected_data.hpp).
/// \throws std::invalid_argument without a file, or for a set of holes without distances.
[[nodiscard]] tl::expected<JointFit, FitFailure> joint_fit(const Measured& measured,
                                                           const JointFitOptions& options = {});

}  // namespace chaintrue::grid
