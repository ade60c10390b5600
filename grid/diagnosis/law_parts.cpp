// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_parts.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/bed_parts.hpp"
#include "grid/diagnosis/law_model.hpp"

namespace chaintrue::grid::diagnosis {
double averaged_over_parts(const Analysis& a,
                           const LawEvidence& evidence,
                           const WeighedLaw& law,
                           double probability) {
  const KeptRows& kept = a.comparison.marginalised_systems[evidence.marginalised].kept;
  const std::vector<BedPart> parts =
      bed_parts(a.system, nothing_rejected(a.system), a.session.fewest_units);
  if (parts.empty()) return probability;
  const LawModel with = model_with(a, evidence, &law);
  const LawModel without = model_with(a, evidence, nullptr);
  const auto all = kept.positions({}, false);
  const double of_all = with.log_density(all) - without.log_density(all);
  // As far as odds are numbers.
  const double sure = std::min(probability, 1.0 - 1e-15);
  const double log_odds = std::log(sure) - std::log1p(-sure);
  double sum = 0.0;
  for (const BedPart& part : parts) {
    const auto rows = kept.positions(part.units, false);
    const double counts = static_cast<double>(all.size()) / static_cast<double>(rows.size());
    const double own = log_odds + counts * (with.log_density(rows) - without.log_density(rows)) - of_all;
    sum += 1.0 / (1.0 + std::exp(-own));
  }
  return std::min(probability, sum / static_cast<double>(parts.size()));
}

}  // namespace chaintrue::grid::diagnosis
