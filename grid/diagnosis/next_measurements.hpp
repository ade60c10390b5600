// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure next to separate the leading hypotheses: a greedy choice that minimises the
/// remaining confusion (expected_discrimination.hpp).
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/expected_discrimination.hpp"
#include "grid/diagnosis/laws.hpp"

namespace chaintrue::grid::diagnosis {

// All possible next measurements, as a session. Private to grid/diagnosis.

/// The accuracy of a reading of 100 links: 0.1 mm.
inline constexpr double kLinkPitchSigmaMm = 0.001;

/// Some rows of the session of candidates.
struct Candidate {
  NextMeasurement measurement;
  Rows rows;
  int times = 1;  ///< it may be chosen
};

/// The session's unknowns are those of the measured session, in its order, followed by those of
/// holes that are not cut yet.
struct NextCandidates {
  ObservationSet session;
  std::vector<Candidate> all;
};

/// Points over the bed and repeated visits if chains were read, distances and holes if a tape was
/// used, and readings of the machine.
NextCandidates next_candidates(const Analysis& analysis);

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
