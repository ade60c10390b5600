// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_parts.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/bed_parts.hpp"
#include "grid/diagnosis/law_model.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Rows = std::vector<Eigen::Index>;

Rows rows_without(const KeptRows& kept, const std::vector<std::size_t>& units) {
  Rows rows;
  for (const KeptRows::Unit& unit : kept.units()) {
    if (contains(units, unit.unit)) continue;
    for (Eigen::Index k = 0; k < unit.rows; ++k) rows.push_back(unit.at + k);
  }
  return rows;
}

}  // namespace

double averaged_over_parts(const Analysis& a,
                           const LawEvidence& evidence,
                           const WeighedLaw& law,
                           double probability) {
  const MarginalisedSystem& marginalised =
      a.comparison.marginalised_systems[evidence.marginalised];
  const std::vector<BedPart> parts =
      bed_parts(a.system, nothing_rejected(a.system), a.session.fewest_units);
  if (parts.empty()) return probability;
  LawModel with(a, marginalised, evidence.sets[law.set], law.discrepancy);
  const Eigen::MatrixXd columns = LawColumns(a.system).of(evidence.curves[law.curve], law.at);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) with.add(Eigen::VectorXd(columns.col(k)));
  const LawModel without(a,
                         marginalised,
                         evidence.sets[evidence.without_set],
                         evidence.without_discrepancy);
  const Rows all = rows_without(marginalised.kept, {});
  const double of_all = with.log_density(all) - without.log_density(all);
  // As far as odds are numbers.
  const double sure = std::min(probability, 1.0 - 1e-15);
  const double log_odds = std::log(sure) - std::log1p(-sure);
  double sum = 0.0;
  for (const BedPart& part : parts) {
    const Rows rows = rows_without(marginalised.kept, part.units);
    const double counts = static_cast<double>(all.size()) / static_cast<double>(rows.size());
    const double own = log_odds + counts * (with.log_density(rows) - without.log_density(rows)) - of_all;
    sum += 1.0 / (1.0 + std::exp(-own));
  }
  return std::min(probability, sum / static_cast<double>(parts.size()));
}

}  // namespace chaintrue::grid::diagnosis
