// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/best_model.hpp"

#include <cmath>

namespace chaintrue::grid::diagnosis {

const Regressor& regressor(const Analysis& a, int k) { return a.system.regressor(k); }

const MarginalisedSystem& marginalised_system(const Analysis& a) {
  return a.comparison.marginalised_systems[a.decision.marginalised];
}

int best_regressor(const Analysis& a, const CauseId& cause) {
  for (const int k : a.decision.regressors) {
    if (regressor(a, k).cause == cause) return k;
  }
  for (const CandidateModel& model : a.comparison.models) {
    if (model.regressors.size() != 1) continue;
    if (regressor(a, model.regressors.front()).cause == cause) return model.regressors.front();
  }
  const MarginalisedSystem& marginalised = marginalised_system(a);
  int best = -1;
  double most = -1.0;
  for (const int k : a.system.regressors_of(cause)) {
    const VectorXd g = reduced(marginalised, a.system.g.col(k));
    const double score = g.squaredNorm() > 1e-12 ? std::abs(g.dot(marginalised.e)) / g.norm() : 0.0;
    if (score > most) {
      most = score;
      best = k;
    }
  }
  return best;
}

void reject_slips(const Analysis& a, Flags& outliers) {
  for (const int k : a.decision.regressors) {
    const Regressor& own = regressor(a, k);
    if (!own.slip) continue;
    for (std::size_t u = 0; u < a.system.units.size(); ++u) {
      const SystemUnit& unit = a.system.units[u];
      if (!unit.reads_chains) continue;
      const SystemPlace& place = a.system.places[unit.places.front().place];
      if (place.ordered && place.order == static_cast<int>(own.values.back())) outliers[u] = true;
    }
  }
}

bool same_class(const Analysis& a, const CauseId& x, const CauseId& y) {
  const std::size_t home = a.decision.class_of(x);
  return x == y || (home < a.decision.classes.size() && home == a.decision.class_of(y));
}

Nearest nearest_other(const Analysis& a, int column) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const VectorXd own = reduced(marginalised, a.system.g.col(column));
  const VectorXd products = with_regressors(a.system, marginalised, own);
  const VectorXd squares = squared_lengths(a.system, marginalised);
  const auto excluded = [&](const CauseId& other) {
    if (same_class(a, other, regressor(a, column).cause)) return true;
    if (a.decision.verdict != Verdict::several_causes) return false;
    return any_of(a.decision.regressors,
                  [&](int k) { return same_class(a, other, regressor(a, k).cause); });
  };
  Nearest nearest;
  for (std::size_t k = 0; k < a.system.regressors.size(); ++k) {
    const auto at = as_index(k);
    if (excluded(a.system.regressors[k].cause)) continue;
    const double collinearity = collinearity_of(products(at), own.norm() * std::sqrt(squares(at)));
    // Among columns that differ only by rounding the first wins, on any processor.
    constexpr double kRounding = 1e-9;
    if (collinearity > nearest.collinearity + kRounding)
      nearest = {static_cast<int>(k), collinearity};
  }
  return nearest;
}

Shown shown(const Analysis& a) {
  Shown result{a.decision.regressors, {}};
  if (result.best.empty() && !a.decision.marginal.empty()) {
    result.best = {
        best_regressor(a, a.decision.classes[a.decision.marginal.front().index].front())};
  }
  if (result.best.empty()) return result;
  int first = result.best.front();
  if (!a.decision.listed.empty()) {
    first = best_regressor(a, a.decision.classes[a.decision.listed.front()].front());
  }
  const Nearest other = nearest_other(a, first);
  if (other.column >= 0) result.rival = {other.column};
  return result;
}

Estimate estimate_with(const Analysis& a, RegressorSet regressors) {
  sort(regressors);
  return estimate(a.system, marginalised_system(a), regressors, a.noise);
}

Estimate estimate_of(const Analysis& a, const RegressorSet& regressors) {
  return estimate(a.system, marginalised_system(a), regressors, -1);
}

}  // namespace chaintrue::grid::diagnosis
