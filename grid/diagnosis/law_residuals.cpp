// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_residuals.hpp"

#include <algorithm>
#include <utility>

#include "grid/containers.hpp"
#include "grid/diagnosis/estimate.hpp"
#include "grid/diagnosis/law_model.hpp"
#include "grid/diagnosis/laws.hpp"

namespace chaintrue::grid::diagnosis {

std::vector<LawResidual> residuals_about(const Analysis& a,
                                         const LawEvidence& evidence,
                                         const WeighedLaw& weighed,
                                         const Law& law) {
  const RegressorSystem& system = a.system;
  const MarginalisedSystem& marginalised = a.comparison.marginalised_systems[evidence.marginalised];
  const LawCurve& curve = evidence.curves[weighed.curve];
  const LawModel model(a, marginalised, evidence.sets[weighed.set], weighed.discrepancy);
  const LawModel::Left left =
      model.left_of(LawColumns(system).of(curve, weighed.at) * weighed.amplitude);
  std::vector<LawResidual> points;
  const bool of_belts = system.is_of_lengths();
  for (const KeptRows::Unit& kept : marginalised.kept.units()) {
    const SystemUnit& unit = system.units[kept.unit];
    if (kept.across || (!of_belts && !unit.reads_chains)) continue;
    LawResidual point;
    point.index = a.session.units[kept.unit].index;
    if (!of_belts) {
      Eigen::VectorXd rows = Eigen::VectorXd::Zero(system.e.size());
      rows.segment(unit.first_row, unit.rows) = left.unexplained.segment(kept.at, kept.rows);
      const Eigen::Vector2d left_mm = error_of_unit(system, rows, kept.unit);
      point.left_x_mm = left_mm.x();
      point.left_y_mm = left_mm.y();
    }
    for (const LawRows& own : law_rows(system, kept.unit, curve)) {
      // Readings that cannot show the law are omitted.
      if (!(own.rows.squaredNorm() > 0.0)) continue;
      point.at = own.v;
      point.residual_mm =
          value_of(law, own.v) +
          own.rows.dot(left.noise.segment(kept.at, kept.rows)) / own.rows.squaredNorm();
      points.push_back(point);
    }
  }
  stable_sort(points, ascending(&LawResidual::index));
  return points;
}

void take_laws(std::vector<Law> laws, Diagnosis& d) {
  double some_law = 0.0;
  for (const Law& law : laws) some_law += law.probability;
  d.unexplained->laws = std::move(laws);
  if (some_law <= 0.0) return;
  some_law = std::min(some_law, 1.0);
  // If a law acts, the residual is neither zero nor only noise.
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
