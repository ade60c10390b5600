// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure next to separate the leading hypotheses: a greedy choice that minimises the
/// remaining confusion (expected_discrimination.hpp).
#pragma once

#include <vector>

#include "grid/diagnosis/expected_discrimination.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/next_candidates.hpp"

namespace chaintrue::grid::diagnosis {

inline constexpr std::size_t kMostNextMeasurements = 8;
/// Nothing is proposed from this probability on.
inline constexpr double kEnough = 0.97;

/// Empty if fewer than two hypotheses remain.
std::vector<NextMeasurement> next_measurements(const Analysis& analysis);

/// Whether nothing is left to distinguish: no name, and one explanation well ahead.
bool is_left_alone(const Analysis& analysis, const std::vector<Alternative>& alternatives);

/// The most informative of these candidates, whose rows are those of the alternatives, one after
/// the other until a name is nearly certain or no further one helps.
std::vector<NextMeasurement> most_telling(const std::vector<Alternative>& alternatives,
                                          std::vector<Candidate> options);

/// Measurements that separate the laws found from each other and from none (laws.hpp). Empty if one
/// is nearly certain.
std::vector<NextMeasurement> next_for_laws(const Analysis& analysis, const LawsFound& found);

}  // namespace chaintrue::grid::diagnosis
