// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The laws that a diagnosis reports: possible variables of a pattern that no listed cause
/// explains, from the evidence for each (law_evidence.hpp).
///
/// Laws of one variable and one way to enter are one answer, with the likeliest of their shapes. The
/// probability is that of the answer whatever its shape; values are those of the likeliest point, sigmas
/// those of the posterior over its curve.
#pragma once

#include <vector>

#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

struct LawsFound {
  std::vector<Law> laws;
  std::vector<WeighedLaw> heaviest;  ///< the likeliest point of each
};

/// Likeliest first, at most three; empty unless all laws together are at least kLawLikely, and if
/// only one cause is requested.
LawsFound laws_found(const Analysis& analysis);

/// Adds them to a complete diagnosis: to its hypotheses and, if no cause is named, its verdict.
void take_laws(std::vector<Law> laws, Diagnosis& diagnosis);
/// The likeliest, if at least kLawClaimed; else null.
const Law* claimed_law(const Diagnosis& diagnosis);
/// Probability that some law acts, from evidence in one or more of the comparison's systems, each with the same
/// laws.
double probability_of_any(const std::vector<LawEvidence>& evidence);

}  // namespace chaintrue::grid::diagnosis
