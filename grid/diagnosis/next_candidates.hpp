// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All possible next measurements, as a session. Private to grid/diagnosis.
#pragma once

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

}  // namespace chaintrue::grid::diagnosis
