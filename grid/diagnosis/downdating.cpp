// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/downdating.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "grid/parallel.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Share of a column's square below which the remainder is rounding: that of one whitened row is
/// 1e-13.
constexpr double kNothingLeft = 1e-9;

/// Columns that are nonzero only in the left-out rows become exactly 0, not a rounding difference.
void clear_unobserved_columns(const NormalEquations& before, NormalEquations& equations) {
  for (const Index i : each_below(equations.gg.rows())) {
    if (equations.gg(i, i) > kNothingLeft * before.gg(i, i)) continue;
    equations.gg.row(i).setZero();
    equations.gg.col(i).setZero();
    equations.ge(i) = 0.0;
  }
}

/// The outlier groups with all of these units set to `rejected`.
Flags with_units(const RegressorSystem& system, Flags groups, const Indices& units, bool rejected) {
  for (const auto k : each_index(groups)) {
    if (contains(units, system.unit_of(system.groups[k]))) groups[k] = rejected;
  }
  return groups;
}

/// The one of these systems that rejects these points; it is made if there is none.
std::size_t home_of(std::vector<MarginalisedSystem>& systems, Flags outliers) {
  const auto* same = find_where(systems, having(&MarginalisedSystem::outliers, outliers));
  if (same != nullptr) return as_size(same - systems.data());
  systems.emplace_back().outliers = std::move(outliers);
  return systems.size() - 1;
}

/// Sets a system's equations to these inner products of its residual and columns.
void take_inner(const LeaveOut::Kept& kept, NormalEquations& equations) {
  const Index count = kept.inner.cols() - 1;
  equations.ee = kept.inner(0, 0);
  equations.ge = kept.inner.col(0).tail(count);
  equations.gg = kept.inner.bottomRightCorner(count, count);
  equations.log_det = kept.log_det;
}

}  // namespace

Downdating::Downdating(const RegressorSystem& system, const ModelComparison& comparison,
                       const FollowedModels& limits)
    : system_(system),
      comparison_(comparison),
      score_(system, comparison.best_system(), system.noise_dof) {
  const auto followed = models_to_follow(limits);
  const std::vector<std::pair<Key, Indices>> all(followed.begin(), followed.end());
  factorisations_.resize(all.size());
  for_each_index(all.size(), [&](std::size_t k) {
    factorisations_[k] = factorisation_of(all[k].first, all[k].second);
  });
}

std::map<Downdating::Key, Indices> Downdating::models_to_follow(
    const FollowedModels& limits) const {
  std::map<Key, double> share;
  for (const CandidateModel& model : comparison_.models) {
    share[{model.marginalised, model.discrepancy}] += comparison_.probability(model);
  }
  std::vector<std::pair<double, Key>> discrepancies;
  for (const auto& [key, p] : share) {
    if (key.second >= 0 && p >= limits.discrepancy_share) discrepancies.emplace_back(-p, key);
  }
  sort(discrepancies);
  if (discrepancies.size() > limits.most_discrepancies)
    discrepancies.resize(limits.most_discrepancies);
  const auto is_followed = [&](const Key& key) {
    return key.second < 0 || any_of(discrepancies, [&](const auto& p) { return p.second == key; });
  };
  const double best = comparison_.best().log_weight;
  std::map<Key, Indices> result;
  std::set<std::pair<Key, CauseId>> alone;
  std::set<std::size_t> marginalised_systems;
  std::size_t taken = 0;
  double last = best;
  // Best first, so that a marginalised system is known before its other models.
  for (const auto number : each_index(comparison_.models)) {
    const CandidateModel& model = comparison_.models[number];
    const Key key{model.marginalised, model.discrepancy};
    if (!is_followed(key)) continue;
    const bool leads = model.log_weight > best - limits.within &&
                       (taken < limits.most || tied(model.log_weight, last));
    bool first_alone = model.regressors.empty();
    if (model.regressors.size() == 1)
      first_alone = alone.emplace(key, system_.regressor(model.regressors[0]).cause).second;
    if (!leads && !(first_alone && marginalised_systems.contains(key.first))) continue;
    if (leads && taken < limits.most) last = model.log_weight;
    taken += leads ? 1 : 0;
    marginalised_systems.insert(key.first);
    result[key].push_back(number);
  }
  return result;
}

Downdating::Factorisation Downdating::factorisation_of(const Key& key,
                                                       const Indices& models) const {
  const MarginalisedSystem& marginalised = comparison_.marginalised_systems[key.first];
  RegressorSet columns;
  for (const std::size_t number : models)
    append_all(columns, comparison_.models[number].regressors);
  sort_unique(columns);
  NormalEquations equations = normal_equations(system_, marginalised, std::move(columns));
  const MatrixXd e = std::exchange(equations.rows, {});
  const MatrixXd pattern = discrepancy_columns(system_, marginalised, key.second);
  Factorisation factorised{
      key, LeaveOut(marginalised.root, LowRankNoise(reduced(marginalised, pattern)), e),
      std::move(equations), models};
  take_inner(factorised.rows.without({}), factorised.equations);
  const NoiseDensity noise(system_.noise_dof, e.rows());
  for (const std::size_t number : models) {
    const CandidateModel& model = comparison_.models[number];
    ColumnSet set = factorised.equations.positions(model.regressors);
    const double evidence =
        set_evidence(factorised.equations, system_.regressors, set, noise).log_evidence;
    factorised.prior.push_back(model.log_weight - evidence - marginalised.log_outliers);
    factorised.sets.push_back(std::move(set));
  }
  return factorised;
}

NormalEquations Downdating::downdated_equations(const Factorisation& factorised,
                                                const Rows& out) const {
  NormalEquations equations = factorised.equations;
  if (out.empty()) return equations;
  take_inner(factorised.rows.without(out), equations);
  clear_unobserved_columns(factorised.equations, equations);
  // With a discrepancy the expected sizes are those of all points.
  if (factorised.key.second < 0) {
    equations.prior_square =
        prior_squares(system_.regressors, equations.columns, equations.gg.diagonal());
  }
  return equations;
}

Downdating::AllWithout Downdating::all_without(const Indices& units, CountAs count_as) const {
  AllWithout result;
  std::map<std::tuple<std::size_t, int, RegressorSet>, std::size_t> known;
  for (const Factorisation& factorised : factorisations_) {
    const MarginalisedSystem& whole = comparison_.marginalised_systems[factorised.key.first];
    const Rows out = whole.kept.positions(units);
    const NormalEquations equations = downdated_equations(factorised, out);
    const Index rows = factorised.rows.rows() - std::ssize(out);
    const NoiseDensity noise(system_.noise_dof, rows);
    const double power = count_as == CountAs::all ? as_double(factorised.rows.rows()) /
                                                        as_double(std::max<Index>(rows, 1))
                                                  : 1.0;
    const double price =
        log_price_of_outliers(system_, with_units(system_, whole.outliers, units, false));
    // Marginalised systems that differ in the points left out alone are one.
    const std::size_t home =
        home_of(result.systems, with_units(system_, whole.outliers, units, true));
    for (const auto k : each_index(factorised.models)) {
      CandidateModel model = comparison_.models[factorised.models[k]];
      model.marginalised = home;
      const auto [same, is_new] =
          known.try_emplace({home, model.discrepancy, model.regressors}, result.models.size());
      if (is_new) {
        const auto evidence =
            set_evidence(equations, system_.regressors, factorised.sets[k], noise);
        model.log_weight = factorised.prior[k] + power * evidence.log_evidence + price;
        model.larger_noise = evidence.larger_noise;
      }
      result.models.push_back({factorised.models[k], same->second, std::move(model)});
    }
    if (factorised.key.second < 0)
      result.strongest.emplace_back(score_.largest(equations, rows), home);
  }
  return result;
}

Downdating::Without Downdating::without(const Indices& units) const {
  AllWithout all = all_without(units, CountAs::themselves);
  Without result;
  ModelComparison& comparison = result.comparison;
  comparison.marginalised_systems = std::move(all.systems);
  for (const auto k : each_index(all.models)) {
    ModelWithout& own = all.models[k];
    if (own.same == k && std::isfinite(own.model.log_weight))
      comparison.models.push_back(std::move(own.model));
  }
  sort_by_weight(comparison);
  for (const auto& [score, marginalised] : all.strongest) {
    if (marginalised == comparison.best().marginalised)
      result.score = std::max(result.score, score);
  }
  return result;
}

VectorXd Downdating::probabilities_without(const Indices& units, CountAs count_as) const {
  const std::vector<ModelWithout> models = all_without(units, count_as).models;
  const auto weight_before = [&](const ModelWithout& own) {
    return comparison_.models[own.number].log_weight;
  };
  // Weights with all points, of those that are one without them.
  std::vector<double> log_all(models.size(), kMinusInfinity);
  std::vector<double> weights;
  for (const auto k : each_index(models)) {
    double& sum = log_all[models[k].same];
    sum = log_sum(sum, weight_before(models[k]));
    const double weight = models[k].model.log_weight;
    if (models[k].same == k && std::isfinite(weight)) weights.push_back(weight);
  }
  const double total = weights.empty() ? 0.0 : log_sum(weights);
  VectorXd result = VectorXd::Zero(std::ssize(comparison_.models));
  for (const ModelWithout& own : models) {
    const double weight = models[own.same].model.log_weight;
    if (std::isfinite(weight))
      result(as_index(own.number)) =
          std::exp(weight - total + weight_before(own) - log_all[own.same]);
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis
