// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Grids and sets of holes of one machine, one file or any number of any mix, in one joint estimate
/// and one map: what they share, the machine, its chains' scales and the residual surface, is learnt
/// from all of them.
///
/// The map's frame is that of the first file's marks; every other file has a sheet of its own, whose
/// placement is estimated and belongs to it alone. Between two grids a chain's zero may have been set
/// anew: each but the first has zeros of its own. The map's zeros are those of the first grid, which is the
/// one to give first: what the machine is like now. A hole is where its chain lengths put it, so
/// that each set's own controller says what was paid out. Each file keeps its own stated noise; one
/// factor over all of them is found, known by the fewest degrees of freedom that any of them
/// states. Of a grid that states no noise it is found from its points first. Readings of the machine
/// count from every file.
///
/// \code
///   const auto fit = joint_fit({{"grid.json", grid}, {"holes.json", holes}});   // or one of them
///   if (fit) write(fit->map);
/// \endcode
#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/map/fitted_distances.hpp"
#include "grid/map/fitted_points.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::grid {

struct JointFitOptions {
  /// What the map does beyond the points.
  OutsideRule outside{};
  Progress progress{};
};

struct JointFit {
  estimation::Estimate estimate;           ///< its observations in the order of the files
  std::vector<FittedPoint> points;         ///< of the files that are grids, in their order
  std::vector<FittedDistances> distances;  ///< of the files that are sets of holes
  CompensationMap map;
};

/// Fails in words where a file has no machine or another machine's settings than the first, or where
/// a third of a file's readings contradict the others. The machine's effects of the paper and of the
/// visit are taken out of grids first (corrected_data.hpp).
/// \throws std::invalid_argument without a file, or for a set of holes without distances.
[[nodiscard]] tl::expected<JointFit, FitFailure> joint_fit(const Measured& measured,
                                                           const JointFitOptions& options = {});

}  // namespace chaintrue::grid
