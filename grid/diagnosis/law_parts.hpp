// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The probability of a law averaged over parts of the bed, as that of causes given a pattern is
/// (bed_parts.hpp): a real pattern is no law exactly, and a likelihood that is nearly right makes large odds
/// out of a few marks. A law that holds is borne out without any quarter of the bed.
///
///   odds_k = odds (f r_k - r),   r = log p(e | law, S, D) - log p(e | S0, D0)
///
/// r_k without quarter k, f the share of rows that it counts for; S, D and S0, D0 the best contexts with the
/// law and without one. The result is the mean of the probabilities, and no more than that of all readings.
/// (J. Huggins and J. Miller, Bayesian Analysis 18 (2023) 79.)
#pragma once

#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// `probability` of all readings. As it is where there are no such parts.
[[nodiscard]] double averaged_over_parts(const Analysis& analysis,
                                         const LawEvidence& evidence,
                                         const WeighedLaw& law,
                                         double probability);

}  // namespace chaintrue::grid::diagnosis
