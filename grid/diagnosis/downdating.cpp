// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/downdating.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "grid/diagnosis/ties.hpp"
#include "grid/parallel.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Share of a column's square below which the remainder is rounding: that of one whitened row is
/// 1e-13.
constexpr double kNothingLeft = 1e-9;

using FactorisationKey = std::pair<std::size_t, int>;  ///< marginalised system, discrepancy

/// The models that may lead without some points: the best ones and, in each of their marginalised
/// systems, no cause and every cause alone at its best place.
std::map<FactorisationKey, std::vector<CandidateModel>> models_to_follow(
    const RegressorSystem& system,
    const ModelComparison& comparison,
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
  std::map<FactorisationKey, std::vector<CauseId>> alone;
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
    if (model.regressors.size() == 1) {
      const CauseId& cause = system.regressor(model.regressors[0]).cause;
      auto& known = alone[key];
      first_alone = !contains(known, cause);
      if (first_alone) known.push_back(cause);
    }
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
  for (Eigen::Index i = 0; i < equations.gg.rows(); ++i) {
    if (equations.gg(i, i) > kNothingLeft * before.gg(i, i)) continue;
    equations.gg.row(i).setZero();
    equations.gg.col(i).setZero();
    equations.ge(i) = 0.0;
  }
}

/// The outlier groups with all of these units set to `rejected`.
Flags with_units(const RegressorSystem& system, Flags groups, const Indices& units, bool rejected) {
  if (system.groups.empty()) {
    for (const std::size_t unit : units) groups[unit] = rejected;
    return groups;
  }
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const auto row = as_size(system.groups[k].first_row);
    const auto own = as_size(system.unit_of_row[row]);
    if (contains(units, own)) groups[k] = rejected;
  }
  return groups;
}

/// The comparison's marginalised system that rejects these points; it is made if there is none.
std::size_t home_of(ModelComparison& comparison, Flags outliers) {
  auto& systems = comparison.marginalised_systems;
  const auto* same =
      find_where(systems, [&](const MarginalisedSystem& own) { return own.outliers == outliers; });
  if (same != nullptr) return as_size(same - systems.data());
  systems.emplace_back().outliers = std::move(outliers);
  return systems.size() - 1;
}

}  // namespace

Downdating::Downdating(const RegressorSystem& system,
                       const ModelComparison& comparison,
                       const FollowedModels& limits)
    : system_(system),
      comparison_(comparison),
      score_(system, comparison.best_system(), system.noise_dof) {
  auto followed = models_to_follow(system, comparison, limits);
  std::vector<std::pair<const FactorisationKey, std::vector<CandidateModel>>*> all;
  for (auto& one : followed) all.push_back(&one);
  factorisations_.resize(all.size());
  for_each_index(all.size(), [&](std::size_t k) {
    auto& [key, models] = *all[k];
    factorisations_[k] = factorisation_of(key.first, key.second, std::move(models));
  });
}

Downdating::Factorisation Downdating::factorisation_of(std::size_t number,
                                                       int discrepancy,
                                                       std::vector<CandidateModel> models) const {
  const MarginalisedSystem& marginalised = comparison_.marginalised_systems[number];
  Factorisation factorised;
  factorised.marginalised = number;
  factorised.discrepancy = discrepancy;
  RegressorSet columns;
  for (const CandidateModel& model : models) {
    append_all(columns, model.regressors);
  }
  sort_unique(columns);
  const Eigen::Index n = marginalised.kept.size();
  Eigen::MatrixXd e(n, std::ssize(columns) + 1);
  e.col(0) = marginalised.e;
  e.rightCols(e.cols() - 1) = marginalised.g.dense(columns);
  double log_det = marginalised.log_det;
  if (discrepancy >= 0) {
    const Discrepancy process = discrepancy_of(system_, marginalised, discrepancy);
    Eigen::MatrixXd k =
        discrepancy_covariance(system_, marginalised.kept, process.kernel);
    k = marginalised.root.solve(k);
    k = marginalised.root.solve(k.transpose()) * (process.sigma_mm * process.sigma_mm);
    k.diagonal().array() += 1.0;
    const linear::Cholesky noise(std::move(k));
    factorised.inverse = marginalised.root.inverse(numbers_below<Eigen::Index>(n));
    noise.half_solve_in_place(factorised.inverse);
    noise.half_solve_in_place(e);
    log_det += noise.log_det();
  }
  factorised.precision = discrepancy < 0 ? marginalised.root.solve(e)
                                         : linear::product(linear::transposed(factorised.inverse), e);
  const Eigen::MatrixXd gram = linear::gram(e);
  const Eigen::Index c = e.cols() - 1;
  factorised.equations = {columns,
                          gram(0, 0),
                          gram.col(0).tail(c),
                          gram.bottomRightCorner(c, c),
                          prior_squares(system_.regressors,
                                        columns,
                                        marginalised.g.dense(columns).colwise().squaredNorm()),
                          log_det};
  const NoiseDensity noise(system_.noise_dof, n);
  for (const CandidateModel& model : models) {
    ColumnSet set;
    for (const int k : model.regressors) set.push_back(factorised.equations.position(k));
    const double evidence =
        set_evidence(factorised.equations, system_.regressors, set, noise).log_evidence;
    factorised.prior.push_back(model.log_weight - evidence - marginalised.log_outliers);
    factorised.sets.push_back(std::move(set));
  }
  factorised.models = std::move(models);
  return factorised;
}

NormalEquations Downdating::downdated_equations(const Factorisation& factorised,
                                                const Rows& out) const {
  NormalEquations equations = factorised.equations;
  if (out.empty()) return equations;
  const Eigen::MatrixXd half =
      factorised.discrepancy < 0
          ? comparison_.marginalised_systems[factorised.marginalised].root.inverse(out)
          : Eigen::MatrixXd(factorised.inverse(Eigen::all, out));
  const linear::Cholesky block(linear::gram(half));
  Eigen::MatrixXd found = factorised.precision(out, Eigen::all);
  block.half_solve_in_place(found);
  const auto columns = found.rightCols(found.cols() - 1);
  equations.ee -= found.col(0).squaredNorm();
  linear::add_product(equations.ge, -1.0, linear::transposed(columns), found.col(0));
  linear::add_gram(equations.gg, -1.0, columns);
  clear_unobserved_columns(factorised.equations, equations);
  equations.log_det += block.log_det();
  // With a discrepancy the expected sizes are those of all points.
  if (factorised.discrepancy < 0) {
    equations.prior_square =
        prior_squares(system_.regressors, equations.columns, equations.gg.diagonal());
  }
  return equations;
}

Downdating::Downdated Downdating::downdated(const Factorisation& factorised,
                                            const Indices& units) const {
  const MarginalisedSystem& whole = comparison_.marginalised_systems[factorised.marginalised];
  const auto out = whole.kept.positions(units);
  Flags outliers = with_units(system_, whole.outliers, units, false);
  const double price = log_price_of_outliers(system_, outliers);
  return {downdated_equations(factorised, out),
          factorised.precision.rows() - std::ssize(out),
          std::move(outliers),
          price};
}

Downdating::Without Downdating::without(const Indices& units) const {
  Without result;
  ModelComparison& comparison = result.comparison;
  std::set<std::tuple<std::size_t, int, RegressorSet>> known;
  std::vector<std::pair<double, std::size_t>> strongest;  // score, by marginalised system
  for (const Factorisation& factorised : factorisations_) {
    const Downdated own = downdated(factorised, units);
    const NoiseDensity noise(system_.noise_dof, own.rows);
    // Marginalised systems that differ in the points left out alone are one.
    const std::size_t home = home_of(comparison, with_units(system_, own.outliers, units, true));
    for (std::size_t k = 0; k < factorised.models.size(); ++k) {
      const CandidateModel& model = factorised.models[k];
      if (!known.emplace(home, factorised.discrepancy, model.regressors).second) continue;
      const SetEvidence evidence =
          set_evidence(own.equations, system_.regressors, factorised.sets[k], noise);
      if (!std::isfinite(evidence.log_evidence)) continue;
      comparison.models.push_back({model.regressors,
                                   factorised.discrepancy,
                                   home,
                                   factorised.prior[k] + evidence.log_evidence + own.price,
                                   evidence.larger_noise,
                                   evidence.quadratic});
    }
    if (factorised.discrepancy < 0)
      strongest.emplace_back(score_.largest(own.equations, own.rows), home);
  }
  sort_by_weight(comparison);
  for (const auto& [score, marginalised] : strongest) {
    if (marginalised == comparison.best().marginalised) result.score = std::max(result.score, score);
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
  struct Same {
    double log_weight = 0.0;
    std::vector<double> log_shares{};  ///< weights with all points, of those that are one without them
    double log_all = 0.0;
  };
  std::map<std::tuple<Flags, int, RegressorSet>, Same> known;
  std::vector<std::pair<Same*, double>> of_model;
  for (const Factorisation& factorised : factorisations_) {
    const Downdated own = downdated(factorised, units);
    const NoiseDensity noise(system_.noise_dof, own.rows);
    const double power =
        count_as == CountAs::all
            ? as_double(factorised.precision.rows()) / as_double(std::max<Eigen::Index>(own.rows, 1))
            : 1.0;
    for (std::size_t k = 0; k < factorised.models.size(); ++k) {
      const CandidateModel& model = factorised.models[k];
      Same& same = known[{own.outliers, factorised.discrepancy, model.regressors}];
      if (same.log_shares.empty()) {
        const double evidence =
            set_evidence(own.equations, system_.regressors, factorised.sets[k], noise).log_evidence;
        same.log_weight = factorised.prior[k] + power * evidence + own.price;
      }
      same.log_shares.push_back(model.log_weight);
      of_model.emplace_back(&same, model.log_weight);
    }
  }
  std::vector<double> weights;
  for (auto& [key, same] : known) {
    same.log_all = log_sum(same.log_shares);
    if (std::isfinite(same.log_weight)) weights.push_back(same.log_weight);
  }
  const double total = weights.empty() ? 0.0 : log_sum(weights);
  std::vector<double> result;
  for (const auto& [same, weight] : of_model) {
    result.push_back(std::isfinite(same->log_weight)
                         ? std::exp(same->log_weight - total + weight - same->log_all)
                         : 0.0);
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis
