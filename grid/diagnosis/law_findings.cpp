// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "grid/containers.hpp"
#include "grid/diagnosis/laws.hpp"

namespace chaintrue::grid::diagnosis {

void take_laws(std::vector<Law> laws, Diagnosis& d) {
  double some_law = 0.0;
  for (const Law& law : laws) some_law += law.probability;
  d.unexplained->laws = std::move(laws);
  if (some_law <= 0.0) return;
  some_law = std::min(some_law, 1.0);
  // Where a law acts it is not nothing, nor the readings alone.
  for (Hypothesis& one : d.hypotheses) {
    if (one.effect == "nothing" || one.effect == "noise" || one.effect == "bad_points")
      one.probability *= 1.0 - some_law;
  }
  d.hypotheses.push_back({"law", "", some_law});
  stable_sort(d.hypotheses, descending(&Hypothesis::probability));
  if (claimed_law(d) != nullptr && d.causes.empty()) d.verdict = Verdict::model_discrepancy;
}

const Law* claimed_law(const Diagnosis& d) {
  if (!d.unexplained || d.unexplained->laws.empty()) return nullptr;
  const Law& first = d.unexplained->laws.front();
  return first.probability >= kLawClaimed ? &first : nullptr;
}

}  // namespace chaintrue::grid::diagnosis
