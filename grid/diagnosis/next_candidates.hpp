// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Everything that might be measured next, as a session of its own. Private to grid/diagnosis.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// How well 100 links are read: to 0.1 mm.
inline constexpr double kLinkPitchSigmaMm = 0.001;

/// Some rows of the session of candidates.
struct Candidate {
  NextMeasurement measurement;
  std::vector<Eigen::Index> rows;
  int times = 1;  ///< it may be chosen
};

/// The session's unknowns are those of what was measured, in its order; those of holes that are not
/// cut yet come after them.
struct NextCandidates {
  Session session;
  std::vector<Candidate> all;
};

/// Points over the bed, visits once more, and readings of the machine.
[[nodiscard]] NextCandidates candidates_at_points(const Session& session, const Analysis& analysis);
/// Distances not measured yet, and holes not cut yet with their distances; observed/next_distances.
[[nodiscard]] NextCandidates candidates_between_holes(const Session& session,
                                                      const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
