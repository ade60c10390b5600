// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Single readings of single belts, and whole places, as outlier groups (outlier_search.hpp) and as
/// units of a belts' system. Private to grid/diagnosis.
///
/// A reading of belt b is the direction Q' e_b of its place's two checks; two readings of a place
/// take both.
#pragma once

#include <vector>

#include "grid/diagnosis/belts_system.hpp"
#include "grid/diagnosis/outlier_search.hpp"

namespace chaintrue::grid::diagnosis {

/// Four of each place, in the order of model::kBelts.
[[nodiscard]] std::vector<OutlierGroup> reading_groups(const BeltsSystem& system);
/// Of them.
[[nodiscard]] OutlierLimits reading_limits(const BeltsSystem& system);

/// The belt of each place whose reading one of these sets, a flag a group, rejects alone: of the
/// first that does.
[[nodiscard]] Suspects suspects_of(const std::vector<std::vector<bool>>& sets);
/// A flag a unit, in a system that is turned to these suspects, of a set with a flag a group.
[[nodiscard]] std::vector<bool> units_of(const std::vector<bool>& set, const Suspects& suspects);
/// What flags of units say.
[[nodiscard]] std::vector<model::PerBelt<bool>> readings_of(const std::vector<bool>& units,
                                                            const Suspects& suspects);

}  // namespace chaintrue::grid::diagnosis
