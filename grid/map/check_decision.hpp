// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the weighed hypotheses of a check come to, whatever was measured: probabilities of the
/// verdicts, the likeliest of these, the hypotheses likeliest first, and what they cannot tell apart. Private to grid.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

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

/// What a check cannot tell apart, where it cannot: `in_words` says a hypothesis, `units` is what was
/// measured, "points".
template <class Check, class Words>
void decide_not_told_apart(Check& check, const Words& in_words, const char* units) {
  if (check.hypotheses.front().probability >= kDecided) return;
  constexpr double kWorthNaming = 0.05;
  std::vector<std::string> others;
  for (const auto& h : check.hypotheses) {
    if (h.probability >= kWorthNaming)
      others.push_back(fmt::format("{} ({:.0f} %)", in_words(h), 100.0 * h.probability));
  }
  check.not_told_apart =
      fmt::format("These {} cannot tell apart: {}.", units, fmt::join(others, "; "));
  if (check.decided) return;
  check.not_told_apart +=
      fmt::format(" Measure more {}, far from each other, before you rely on either.", units);
}

}  // namespace chaintrue::grid
