// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure next so that the leading hypotheses part.
///
/// Chosen one after the other to make the confusion that is left (expected_discrimination.hpp) smallest.
#pragma once

#include <vector>

#include "grid/diagnosis/next_candidates.hpp"
#include "grid/diagnosis/expected_discrimination.hpp"
#include "grid/diagnosis/laws.hpp"

namespace chaintrue::grid::diagnosis {

inline constexpr std::size_t kMostNextMeasurements = 8;
/// Probability from which on nothing more is proposed.
inline constexpr double kEnough = 0.97;

/// Empty where fewer than two hypotheses are left to tell apart.
[[nodiscard]] std::vector<NextMeasurement> next_measurements(const Analysis& analysis);

/// Whether there is nothing to tell apart: no name to be sure of, and one explanation well ahead.
[[nodiscard]] bool is_left_alone(const Analysis& analysis,
                                 const std::vector<Alternative>& alternatives);

/// Of these candidates, whose rows are those of the alternatives, the most telling one after the
/// other, until a name is as good as sure or no other one pays. None where something is named already.
[[nodiscard]] std::vector<NextMeasurement> most_telling(
    const std::vector<Alternative>& alternatives,
    std::vector<Candidate> options,
    bool is_named);

/// What tells the laws found from each other and from none (laws.hpp). Empty where one is as good as sure.
[[nodiscard]] std::vector<NextMeasurement> next_for_laws(const Analysis& analysis,
                                                         const LawsFound& found);

}  // namespace chaintrue::grid::diagnosis
