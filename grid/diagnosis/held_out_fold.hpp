// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One fold of what a name gains: the naming and every fit repeated without its units, and what
/// each way of modelling then leaves at them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Errors of the tool in mm, for every way of modelling.
struct Errors {
  std::vector<Eigen::Vector2d> calibrated, surface_only;
  /// With the causes that the fold itself names.
  std::vector<Eigen::Vector2d> extended, extended_and_surface;
  /// With the causes that all units name, their sizes fitted without the fold.
  std::vector<Eigen::Vector2d> fixed_naming, fixed_naming_and_surface;
};

/// Held-out units of one fold.
struct Fold {
  std::vector<std::size_t> units;
  Errors errors;
  std::vector<CauseClass> named;
};

/// \param units  of the analysis' session, to be left out of everything. The same gate, comparison and
/// decision as for all units; units that are outliers or slips of the whole session are not among
/// the fold's.
[[nodiscard]] Fold hold_out(const Analysis& analysis, const std::vector<std::size_t>& units);

}  // namespace chaintrue::grid::diagnosis
