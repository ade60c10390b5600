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

using FactorisationKey = std::pair<std::size_t, int>;  ///< marginalised system, discrepancy

/// The models that may lead without some points: the best ones and, in each of their marginalised
/// systems, no cause and every cause alone at its best place.
std::map<FactorisationKey, std::vector<CandidateModel>> models_to_follow(
    const RegressorSystem& system, const ModelComparison& comparison,
    const FollowedModels& limits) {
  std::map<FactorisationKey, double> share;
  for (const CandidateModel& model : comparison.models) {
    share[{model.marginalised, model.discrepancy}] += comparison.probability(model);
  }
  std::vector<std::pair<double, FactorisationKey>> discrepancies;
  for (const auto& [key, p] : share) {
    if (key.second >= 0 && p >= limits.discrepancy_share) discrepancies.emplace_back(-p, key);
  }
  sort(discrepancies);
  if (discrepancies.size() > limits.most_discrepancies)
    discrepancies.resize(limits.most_discrepancies);
  const auto is_followed = [&](const FactorisationKey& key) {
    return key.second < 0 || any_of(discrepancies, [&](const auto& p) { return p.second == key; });
  };
  const double best = comparison.best().log_weight;
  std::map<FactorisationKey, std::vector<CandidateModel>> result;
  std::set<std::pair<FactorisationKey, CauseId>> alone;
  std::set<std::size_t> marginalised_systems;
  std::size_t taken = 0;
  double last = best;
  // Best first, so that a marginalised system is known before its other models.
  for (const CandidateModel& model : comparison.models) {
    const FactorisationKey key{model.marginalised, model.discrepancy};
    if (!is_followed(key)) continue;
    const bool leads = model.log_weight > best - limits.within &&
                       (taken < limits.most || tied(model.log_weight, last));
    bool first_alone = model.regressors.empty();
    if (model.regressors.size() == 1)
      first_alone = alone.emplace(key, system.regressor(model.regressors[0]).cause).second;
    if (!leads && !(first_alone && marginalised_systems.contains(key.first))) continue;
    if (leads && taken < limits.most) last = model.log_weight;
    taken += leads ? 1 : 0;
    marginalised_systems.insert(key.first);
    result[key].push_back(model);
  }
  return result;
}

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
  auto followed = models_to_follow(system, comparison, limits);
  std::vector<std::pair<const FactorisationKey, std::vector<CandidateModel>>*> all;
  for (auto& one : followed) all.push_back(&one);
  std::vector<std::optional<Factorisation>> made(all.size());
  for_each_index(all.size(), [&](std::size_t k) {
    auto& [key, models] = *all[k];
    made[k] = factorisation_of(key.first, key.second, std::move(models));
  });
  for (auto& own : made) factorisations_.push_back(*std::move(own));
}

Downdating::Factorisation Downdating::factorisation_of(std::size_t number, int discrepancy,
                                                       std::vector<CandidateModel> models) const {
  const MarginalisedSystem& marginalised = comparison_.marginalised_systems[number];
  RegressorSet columns;
  for (const CandidateModel& model : models) append_all(columns, model.regressors);
  sort_unique(columns);
  NormalEquations equations = normal_equations(system_, marginalised, std::move(columns));
  const MatrixXd e = std::exchange(equations.rows, {});
  const MatrixXd pattern = discrepancy_columns(system_, marginalised, discrepancy);
  Factorisation factorised{
      number, discrepancy,
      LeaveOut(marginalised.root, LowRankNoise(reduced(marginalised, pattern)), e),
      std::move(equations), std::move(models)};
  take_inner(factorised.rows.without({}), factorised.equations);
  const NoiseDensity noise(system_.noise_dof, e.rows());
  for (const CandidateModel& model : factorised.models) {
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
  if (factorised.discrepancy < 0) {
    equations.prior_square =
        prior_squares(system_.regressors, equations.columns, equations.gg.diagonal());
  }
  return equations;
}

Downdating::AllWithout Downdating::all_without(const Indices& units, CountAs count_as) const {
  AllWithout result;
  std::map<std::tuple<std::size_t, int, RegressorSet>, std::size_t> known;
  for (const Factorisation& factorised : factorisations_) {
    const MarginalisedSystem& whole = comparison_.marginalised_systems[factorised.marginalised];
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
      const CandidateModel& model = factorised.models[k];
      const auto [same, is_new] =
          known.try_emplace({home, factorised.discrepancy, model.regressors}, result.models.size());
      ModelWithout own{&model, home, same->second, {}, 0.0};
      if (is_new) {
        own.evidence = set_evidence(equations, system_.regressors, factorised.sets[k], noise);
        own.log_weight = factorised.prior[k] + power * own.evidence.log_evidence + price;
      }
      result.models.push_back(own);
    }
    if (factorised.discrepancy < 0)
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
    const ModelWithout& own = all.models[k];
    if (own.same != k || !std::isfinite(own.log_weight)) continue;
    comparison.models.push_back({own.model->regressors, own.model->discrepancy, own.home,
                                 own.log_weight, own.evidence.larger_noise});
  }
  sort_by_weight(comparison);
  for (const auto& [score, marginalised] : all.strongest) {
    if (marginalised == comparison.best().marginalised)
      result.score = std::max(result.score, score);
  }
  return result;
}

std::vector<const CandidateModel*> Downdating::followed() const {
  std::vector<const CandidateModel*> result;
  for (const Factorisation& factorised : factorisations_) {
    for (const CandidateModel& model : factorised.models) result.push_back(&model);
  }
  return result;
}

std::vector<double> Downdating::probabilities_without(const Indices& units,
                                                      CountAs count_as) const {
  const std::vector<ModelWithout> models = all_without(units, count_as).models;
  // Weights with all points, of those that are one without them.
  std::vector<double> log_all(models.size(), kMinusInfinity);
  std::vector<double> weights;
  for (const auto k : each_index(models)) {
    double& sum = log_all[models[k].same];
    sum = log_sum(sum, models[k].model->log_weight);
    if (models[k].same == k && std::isfinite(models[k].log_weight))
      weights.push_back(models[k].log_weight);
  }
  const double total = weights.empty() ? 0.0 : log_sum(weights);
  std::vector<double> result;
  for (const ModelWithout& own : models) {
    const double weight = models[own.same].log_weight;
    result.push_back(std::isfinite(weight)
                         ? std::exp(weight - total + own.model->log_weight - log_all[own.same])
                         : 0.0);
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis
