// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All possible next measurements, as a session. Private to grid/diagnosis.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

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

/// One observation of candidates; `rows` are its own.
struct CandidateReadings {
  FollowUp observation;
  std::vector<Candidate> all;
};
/// For a part with distances: those not measured yet, and holes not cut yet with their distances.
/// Empty if nothing of this kind can be measured.
std::optional<CandidateReadings> candidate_distances(const Analysis& analysis, std::size_t part);

}  // namespace chaintrue::grid::diagnosis
