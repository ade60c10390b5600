// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/model_collector.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "grid/diagnosis/model_comparison.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kLeastSquare = 1e-8;
/// This many leading causes are projected out in turn.
constexpr std::size_t kTakenOut = 3;

/// Adds the places of each cause that explain most of `e`.
void add_best(const RegressorSystem& system, const MatrixXd& g, const VectorXd& e,
              std::size_t of_a_cause, std::set<int>& chosen) {
  const VectorXd c = linear::inner(g, e);
  const VectorXd square = g.colwise().squaredNorm();
  ScoredRegressors scores;
  const auto take = [&] {
    stable_sort(scores, descending(&ScoredRegressors::value_type::first));
    if (scores.size() > of_a_cause) scores.resize(of_a_cause);
    for (const auto& [score, k] : scores) chosen.insert(k);
    scores.clear();
  };
  for (const auto k : each_index(system.regressors)) {
    const Regressor& own = system.regressors[k];
    if (k > 0 && own.cause != system.regressors[k - 1].cause) take();
    const auto at = as_index(k);
    if (!(square(at) > kLeastSquare)) continue;
    scores.emplace_back(score_alone(own, c(at), square(at)), as_int(k));
  }
  take();
}

/// The best of each cause's places, after projection on the settings and also after projection on a
/// leading cause.
RegressorSet best_of_each_cause(const RegressorSystem& system,
                                const MarginalisedSystem& marginalised, std::size_t of_a_cause) {
  std::set<int> chosen;
  const MatrixXd all =
      reduced(marginalised, system.g.dense(numbers_below<int>(system.regressors.size())));
  add_best(system, all, marginalised.e, of_a_cause, chosen);
  ScoredRegressors likeliest;
  for (const int k : chosen) {
    if (system.regressor(k).fixed) continue;
    const auto g = all.col(k);
    likeliest.emplace_back(std::abs(g.dot(marginalised.e)) / g.norm(), k);
  }
  std::sort(likeliest.rbegin(), likeliest.rend());
  std::vector<CauseId> taken;
  for (const auto& [score, k] : likeliest) {
    const CauseId& cause = system.regressor(k).cause;
    if (taken.size() == kTakenOut) break;
    if (contains(taken, cause)) continue;
    taken.push_back(cause);
    const VectorXd own = all.col(k).normalized();
    MatrixXd g = all;
    const VectorXd along = linear::inner(all, own);
    for (const Index column : each_below(g.cols())) g.col(column) -= along[column] * own;
    add_best(system, g, marginalised.e - own * own.dot(marginalised.e), of_a_cause, chosen);
  }
  return {chosen.begin(), chosen.end()};
}

}  // namespace

void SetSearch::run() {
  const RegressorSystem& system = collector_.system();
  const MarginalisedSystem& marginalised = collector_.marginalised();
  const std::size_t few = collector_.limits().of_a_cause;
  equations_ = normal_equations(
      system, marginalised, few == 0 ? columns() : best_of_each_cause(system, marginalised, few));
  if (few > 0) {
    search_by_beam(equations_, -1, collector_);
    return;
  }
  sets_.weigh({});
  for (const Index k : each_below(equations_.ge.size())) sets_.weigh({k});
  pairs();
  sets_.grow(2, {.parents = kBeam}, [&](const ColumnSet& parent) { return extensions(parent); });
}

std::vector<double> SetSearch::run_given_discrepancies(const Indices& kernels) {
  std::vector<WeighedSet> leading;
  for (std::size_t size = 2; size <= kMostCauses; ++size) {
    std::vector<WeighedSet> own = sets_.of_size(size);
    keep_best(own, kSetsGivenDiscrepancy, &WeighedSet::weight);
    append_all(leading, own);
  }
  stable_sort(leading, descending(&WeighedSet::weight));
  std::vector<RegressorSet> likeliest;
  for (const WeighedSet& own : leading) {
    RegressorSet& regressors = likeliest.emplace_back();
    for (const Index i : own.set) regressors.push_back(equations_.columns[as_size(i)]);
  }
  return search_given_discrepancies(equations_, likeliest, kernels, collector_);
}

RegressorSet SetSearch::columns() const {
  const RegressorSystem& system = collector_.system();
  const MarginalisedSystem& marginalised = collector_.marginalised();
  RegressorSet kept;
  RegressorSet fixed;
  RegressorSet shifts;
  const auto count = as_int(system.regressors.size());
  const VectorXd c = with_regressors(system, marginalised, marginalised.e);
  const VectorXd square = squared_lengths(system, marginalised);
  for (const int k : each_below(count)) {
    const Regressor& d = system.regressor(k);
    if (!(square(k) > kLeastSquare)) continue;
    // Shifts of any size set in at a visit.
    (d.fixed ? fixed : d.sets_in() ? shifts : kept).push_back(k);
  }
  const auto explained = [&](int k) { return score_alone(system.regressor(k), c(k), square(k)); };
  keep_best(shifts, kKeptShifts, explained);
  RegressorSet likeliest = kept;
  append_all(kept, shifts);
  keep_best(likeliest, 8, explained);
  const MatrixXd cross =
      with_regressors(system, marginalised, reduced(marginalised, system.g.dense(likeliest)));
  ScoredRegressors gains;
  for (const int k : fixed) {
    double best = explained(k);
    for (const auto l : each_index(likeliest)) {
      const double ll = square(likeliest[l]);
      const double x = cross(k, as_index(l));
      best = std::max(best, 2.0 * (c(k) - x * c(likeliest[l]) / ll) - (square(k) - x * x / ll));
    }
    gains.emplace_back(best, k);
  }
  keep_best(gains, kKeptFixed);
  for (const auto& [gain, k] : gains) kept.push_back(k);
  return kept;
}

double SetSearch::quick_weight(Index i, Index j) const {
  // One after the other, fixed ones first.
  if (sets_.regressor(j).fixed) std::swap(i, j);
  const MatrixXd& gg = equations_.gg;
  double q = equations_.ee;
  double weight = 0.0;
  // Adds a regressor with this inner product with the residual and this square; returns its
  // coefficient and what that changes with the product.
  const auto add = [&](Index k, double c, double square) {
    const Regressor& own = sets_.regressor(k);
    weight += own.log_prior;
    if (own.fixed) {
      q += square - 2.0 * c;
      return std::pair(1.0, 0.0);
    }
    const double prior = equations_.prior_square(k);
    const double whole = square + prior / (kWideSignalToNoise * kWideSignalToNoise);
    q -= c * c / whole;
    weight -= std::log(kUsualSignalToNoise * std::sqrt(whole / prior));
    return std::pair(c / whole, 1.0 / whole);
  };
  const auto [coefficient, slope] = add(i, equations_.ge(i), gg(i, i));
  const double across = gg(i, j);
  add(j, equations_.ge(j) - across * coefficient, gg(j, j) - across * across * slope);
  const double dof = collector_.system().noise_dof;
  const auto n = as_double(collector_.marginalised().kept.size());
  return weight - 0.5 * (n + dof) * std::log(dof + std::max(q, 0.0));
}

void SetSearch::pairs() {
  const auto count = std::ssize(equations_.columns);
  std::vector<std::pair<double, ColumnSet>> quick;
  double best = kMinusInfinity;
  for (const Index i : each_below(count)) {
    for (const Index j : each_below(i)) {
      if (!compatible(sets_.regressor(i), sets_.regressor(j), collector_.limits())) continue;
      const double weight = quick_weight(i, j);
      if (weight < best - kPairsWithin) continue;
      best = std::max(best, weight);
      quick.push_back({weight, {j, i}});
    }
  }
  keep_best(quick, kMostPairs + 1);
  for (const auto& [weight, set] : quick) {
    if (weight < best - kPairsWithin) break;
    sets_.weigh(set);
  }
}

ColumnSet SetSearch::extensions(const ColumnSet& parent) const {
  // The parent's residual and that of each regressor give a score for the cost of one inner
  // product.
  const linear::PivotedCholesky own(equations_.gg(parent, parent));
  const MatrixXd across = equations_.gg(Eigen::all, parent);
  VectorXd left = equations_.ge;
  linear::add_product(left, -1.0, across, own.solve(VectorXd(equations_.ge(parent))));
  const MatrixXd shares = own.solve(across.transpose());
  std::vector<std::pair<double, Index>> order;
  for (const Index i : each_below(left.size())) {
    if (!sets_.fits(parent, i)) continue;
    const double square = equations_.gg(i, i) - across.row(i).dot(shares.col(i));
    if (!(square > 1e-6 * equations_.gg(i, i))) continue;
    const Regressor& regressor = sets_.regressor(i);
    order.emplace_back(score_alone(regressor, left(i), square) + 2.0 * regressor.log_prior, i);
  }
  keep_best(order, kChildren);
  ColumnSet result;
  for (const auto& [score, column] : order) result.push_back(column);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
