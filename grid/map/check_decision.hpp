// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the weighed hypotheses of a check come to, whatever was measured: probabilities of the
/// verdicts, the likeliest of these, and the hypotheses likeliest first. Private to grid.
#pragma once

#include <algorithm>
#include <cstddef>

#include "grid/map/map_check.hpp"

namespace chaintrue::grid {

/// Of a MapCheck or an AnchorsCheck. Precondition: it has a hypothesis.
template <class Check>
void decide_verdict(Check& check) {
  for (const auto& h : check.hypotheses)
    check.probability[static_cast<std::size_t>(h.verdict)] += h.probability;
  std::stable_sort(check.hypotheses.begin(),
                   check.hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  const auto best = std::max_element(check.probability.begin(), check.probability.end());
  check.verdict = static_cast<CheckVerdict>(best - check.probability.begin());
  check.decided = *best >= kDecided;
  // What is told first is what speaks most for the verdict.
  const auto first = std::find_if(check.hypotheses.begin(),
                                  check.hypotheses.end(),
                                  [&](const auto& h) { return h.verdict == check.verdict; });
  std::rotate(check.hypotheses.begin(), first, first + 1);
}

}  // namespace chaintrue::grid
