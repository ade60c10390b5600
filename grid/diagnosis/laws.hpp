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

#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Likeliest first, at most three; empty unless all laws together are at least kLawLikely, where one
/// cause alone is asked for, and where no chain was read at a mark.
[[nodiscard]] std::vector<Law> laws_found(const Analysis& analysis);

/// The same from evidence in one or more of the comparison's systems, each weighed with the same laws.
[[nodiscard]] std::vector<Law> laws_of(const Analysis& analysis,
                                       const std::vector<LawEvidence>& evidence);
/// That some law acts.
[[nodiscard]] double probability_of_any(const std::vector<LawEvidence>& evidence);

}  // namespace chaintrue::grid::diagnosis
