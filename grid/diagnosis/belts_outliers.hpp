// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Single readings of single belts, and whole places, that some hypothesis would rather do without.
/// Private to grid/diagnosis.
///
/// Mean shifts one after the other, as outlier_search.hpp has them for units; a reading of one belt is
/// the direction v = Q' e_b of its place's two checks:
///
///   drop = (v'r)^2 / v' (I - X C X') v,   C = (X'X + prior)^-1                              (1)
///
/// of the quadratic form, with X the rows of anchors and sizes and r what they leave. A second reading
/// of a place takes what is left of it.
#pragma once

#include <vector>

#include "grid/diagnosis/belts_system.hpp"
#include "grid/diagnosis/options.hpp"

namespace chaintrue::grid::diagnosis {

/// What a hypothesis sets aside.
struct BadReadings {
  std::vector<model::PerBelt<bool>> bad;  ///< of each place
  double log_weight = 0.0;
};

/// The most probable first, each once; `hypotheses` are sets of regressors.
[[nodiscard]] std::vector<BadReadings> bad_readings(const BeltsSystem& system,
                                                    const std::vector<std::vector<int>>& hypotheses);

/// The belt of each place whose reading one of these sets aside alone: of the first that does.
[[nodiscard]] Suspects suspects_of(const std::vector<BadReadings>& sets);
/// A flag a unit, in a system that is turned to these suspects.
[[nodiscard]] std::vector<bool> units_of(const BadReadings& set, const Suspects& suspects);
/// What flags of units say.
[[nodiscard]] std::vector<model::PerBelt<bool>> readings_of(const std::vector<bool>& units,
                                                            const Suspects& suspects);

}  // namespace chaintrue::grid::diagnosis
