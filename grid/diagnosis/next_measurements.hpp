// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure next so that the leading hypotheses part.
///
/// Chosen one after the other to make the confusion that is left (expected_discrimination.hpp) smallest.
#pragma once

#include <vector>

#include "grid/diagnosis/next_candidates.hpp"
#include "grid/diagnosis/expected_discrimination.hpp"

namespace chaintrue::grid::diagnosis {

inline constexpr std::size_t kMostNextMeasurements = 8;

/// Empty where fewer than two hypotheses are left to tell apart.
[[nodiscard]] std::vector<NextMeasurement> next_measurements(const Analysis& analysis);

/// Whether there is nothing to tell apart: no name to be sure of, and one explanation well ahead.
[[nodiscard]] bool is_left_alone(const Analysis& analysis,
                                 const std::vector<Alternative>& alternatives);

/// Of these candidates, whose rows are those of the alternatives, the most telling one after the
/// other, until a name is as good as sure or no other one pays.
[[nodiscard]] std::vector<NextMeasurement> most_telling(
    const Analysis& analysis,
    const std::vector<Alternative>& alternatives,
    std::vector<Candidate> options);

}  // namespace chaintrue::grid::diagnosis
