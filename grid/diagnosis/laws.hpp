// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The laws that a diagnosis reports: what a pattern that no listed cause explains is a function of,
/// from the evidence for each (law_evidence.hpp).
///
/// Laws of one variable and one way to enter are one answer, with the likeliest of their shapes. The
/// probability is that of the answer whatever its shape; values are those of the likeliest point, sigmas
/// those of the posterior over its curve.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Laws with the evidence that they come from.
struct LawsFound {
  std::vector<Law> laws;
  std::vector<LawEvidence> evidence;
  /// Of each law, into evidence and into its laws.
  struct Heaviest {
    std::size_t evidence = 0;
    std::size_t law = 0;
  };
  std::vector<Heaviest> heaviest;
};

/// Likeliest first, at most three; empty unless all laws together are at least kLawLikely, and where one
/// cause alone is asked for.
[[nodiscard]] LawsFound laws_found(const Analysis& analysis);

/// The same from evidence in one or more of the comparison's systems, each weighed with the same laws.
[[nodiscard]] LawsFound laws_of(const Analysis& analysis, std::vector<LawEvidence> evidence);
/// Puts them into a diagnosis that has its findings: its hypotheses, and its verdict where no cause is named.
void take_laws(std::vector<Law> laws, Diagnosis& diagnosis);
/// The likeliest, from kLawClaimed on; null where none is.
[[nodiscard]] const Law* claimed_law(const Diagnosis& diagnosis);
/// That some law acts.
[[nodiscard]] double probability_of_any(const std::vector<LawEvidence>& evidence);

}  // namespace chaintrue::grid::diagnosis
