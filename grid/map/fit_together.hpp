// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Grids and sets of holes of one machine in one joint estimate and one map: what they share, the
/// machine, its chains' scales and the residual surface, is learnt from all of them.
///
/// The map's frame is that of the first file's marks; every other file has a sheet of its own, whose
/// placement is estimated and belongs to it alone. A hole is where its chain lengths put it, so
/// that each set's own controller says what was paid out. Each file keeps its own stated noise; one
/// factor over all of them is found, known by the fewest degrees of freedom that any of them
/// states. Of a grid that states no noise it is found from its points first.
///
/// \code
///   const auto fit = fit_together({{"grid.json", grid}, {"holes.json", holes}});
///   if (fit) write(fit->map);
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/holes_fit.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::grid {

/// A set of holes among the files.
struct HolesAmongFiles {
  std::size_t file = 0;
  FittedDistances fit;
};

struct TogetherFit {
  estimation::Estimate estimate;  ///< its observations in the order of the files
  std::vector<HolesAmongFiles> holes;
  CompensationMap map;
};

/// Fails in words where a file has no machine or another machine's settings than the first, as the
/// fit of a single file fails, or where a third of a file's readings contradict the others.
/// \throws std::invalid_argument without a file.
[[nodiscard]] tl::expected<TogetherFit, FitFailure> fit_together(
    const Measured& measured, const Progress& progress = {});

}  // namespace chaintrue::grid
