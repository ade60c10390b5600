// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure next so that the leading hypotheses part.
///
/// Chosen one after the other to make the confusion that is left (outlook.hpp) smallest.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

inline constexpr std::size_t kMostNextMeasurements = 8;

/// Empty where fewer than two hypotheses are left to tell apart.
[[nodiscard]] std::vector<NextMeasurement> next_measurements(const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
