// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "grid/diagnosis/estimate.hpp"
#include "grid/diagnosis/model_collector.hpp"
#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// `odds` multiplies those of causes against none; all priors still sum to one.
double prior_of_count(std::size_t causes, double odds) {
  const std::array<double, kMostCauses + 1> prior = {kPriorOfNothing, kPriorOfOne, kPriorOfTwo,
                                                     kPriorOfThree, kPriorOfFour};
  if (odds == 1.0) return prior.at(causes);
  const double some = kPriorOfOne + kPriorOfTwo + kPriorOfThree + kPriorOfFour;
  const double factor = causes > 0 ? odds : 1.0;
  return factor * prior.at(causes) * (kPriorOfNothing + some) / (kPriorOfNothing + odds * some);
}

/// No cause, and each cause alone at its best place.
std::vector<RegressorSet> first_hypotheses(const RegressorSystem& system, const Flags& excluded,
                                           const ComparisonOptions& options) {
  const MarginalisedSystem marginalised = marginalise(system, excluded);
  std::vector<RegressorSet> hypotheses = {{}};
  for (const CauseScore& own : single_scores(system, marginalised, marginalised.e)) {
    if (own.best_regressor >= 0) hypotheses.push_back({own.best_regressor});
  }
  append_all(hypotheses, options.hypotheses);
  return hypotheses;
}

}  // namespace

const CandidateModel& ModelComparison::best() const {
  if (models.empty()) {
    throw precondition("no models to choose from ({} systems, total weight {})",
                       marginalised_systems.size(), log_total);
  }
  return models.front();
}

double ModelComparison::probability(const CandidateModel& model) const {
  return std::exp(model.log_weight - log_total);
}

void sort_by_weight(ModelComparison& comparison) {
  stable_sort(comparison.models, descending(&CandidateModel::log_weight));
  comparison.log_total = log_sum(mapped(comparison.models, &CandidateModel::log_weight));
}

double log_prior(const RegressorSystem& system, const RegressorSet& set, bool discrepancy) {
  std::size_t lasting = 0, expected = 0;
  double value = discrepancy ? std::log(kDiscrepancyPrior) : 0.0;
  for (const int k : set) {
    const Regressor& d = system.regressor(k);
    value += d.log_prior - std::log(system.prior.shares);
    if (d.expected) {
      value += std::log(kPriorOfOne / kPriorOfNothing);
      if (++expected > 1) value += std::log(kPriorOfTwo / kPriorOfOne);
    } else if (!d.slip) {
      ++lasting;
    }
  }
  const double odds = discrepancy ? system.prior.odds_given_discrepancy : 1.0;
  return value + std::log(prior_of_count(lasting, odds)) + std::lgamma(1.0 + as_double(lasting));
}

double log_odds_of_another(const RegressorSystem& system, const RegressorSet& set,
                           bool discrepancy) {
  const auto lasting = count_where(set, [&](int k) {
    const Regressor& d = system.regressor(k);
    return !d.expected && !d.slip;
  });
  if (lasting == kMostCauses) return kMinusInfinity;
  const double odds = discrepancy ? system.prior.odds_given_discrepancy : 1.0;
  return std::log(prior_of_count(lasting + 1, odds) / prior_of_count(lasting, odds)) +
         std::log(1.0 + as_double(lasting)) - std::log(system.prior.shares);
}

std::vector<CauseScore> single_scores(const std::vector<Regressor>& regressors, const VectorXd& c,
                                      const VectorXd& square, double ee,
                                      const NoiseDensity& noise) {
  std::vector<CauseScore> scores;
  const double nothing = noise.log_density(ee);
  double best = kMinusInfinity;  // of the current cause
  NormalEquations equations;
  equations.ee = ee;
  const std::array<Index, 1> first = {0};
  for (const auto k : each_index(regressors)) {
    const Regressor& own = regressors[k];
    if (scores.empty() || scores.back().cause != own.cause) {
      scores.push_back({own.cause});
      best = kMinusInfinity;
    }
    const auto at = as_index(k);
    if (!(square(at) > 1e-8)) continue;
    equations.columns = {as_int(k)};
    equations.ge = c.segment<1>(at);
    equations.gg = equations.prior_square = square.segment<1>(at);
    const double factor =
        set_evidence(equations, regressors, first, noise).log_evidence - nothing + own.log_prior;
    scores.back().log_factor = log_sum(scores.back().log_factor, factor);
    if (factor > best) {
      best = factor;
      scores.back().best_regressor = as_int(k);
    }
  }
  return scores;
}

std::vector<CauseScore> single_scores(const RegressorSystem& system,
                                      const MarginalisedSystem& marginalised, const VectorXd& e) {
  return single_scores(system.regressors, with_regressors(system, marginalised, e),
                       squared_lengths(system, marginalised), e.squaredNorm(),
                       NoiseDensity(system.noise_dof, marginalised.kept.size()));
}

namespace {

/// The best model's outliers that are off by a whole number of links: each set of outliers is tried
/// again without one of them.
std::vector<Flags> sets_without_links(const RegressorSystem& system, const Flags& excluded,
                                      const ModelComparison& comparison) {
  const MarginalisedSystem& marginalised = comparison.best_system();
  const Estimate fitted = estimate(system, marginalised, comparison.best().regressors, -1);
  std::vector<Flags> result;
  for (const auto i : each_index(marginalised.outliers)) {
    // A rejected direction is not a whole reading that is off by links.
    if (!marginalised.outliers[i] || excluded[i] || system.groups[i].direction) continue;
    const SystemUnit& unit = system.units[i];
    bool links = false;
    for (std::size_t k = 0; k < system.regressors.size() && !links; ++k) {
      if (!system.regressors[k].fixed) continue;
      const auto g = system.g.col(as_index(k)).segment(unit.first_row, unit.rows);
      links = g.squaredNorm() > 0.0 &&
              (unit.segment(fitted.left) - g).squaredNorm() < kLinksAlike * fitted.noise_square;
    }
    if (!links) continue;
    Flags without = marginalised.outliers;
    without[i] = false;
    const bool known =
        any_of(comparison.marginalised_systems, having(&MarginalisedSystem::outliers, without));
    if (!known) result.push_back(std::move(without));
  }
  return result;
}

/// Heaviest first; untried ones keep their order.
Indices by_weight(const Indices& kernels, const std::vector<double>& weight) {
  auto order = numbers_below(kernels.size());
  stable_sort(order, descending([&](std::size_t k) { return weight[k]; }));
  for (std::size_t& k : order) k = kernels[k];
  return order;
}

class Comparer {
 public:
  Comparer(const RegressorSystem& system, const Flags& excluded, const ComparisonOptions& options)
      : system_(system), excluded_(excluded), options_(options) {}

  void compare_with(const std::vector<Flags>& sets) {
    std::deque<SetSearch> searches;
    double best = kMinusInfinity;
    for (const auto& outliers : sets) {
      auto& systems = comparison_.marginalised_systems;
      if (systems.size() == kMostOutlierSets) break;
      systems.push_back(marginalise(system_, outliers));
      searches.emplace_back(system_, comparison_, options_.search).run();
      best = std::max(best, searches.back().best());
    }
    if (options_.discrepancies) {
      if (options_.search.of_a_cause > 0) {
        look_alongside_likeliest(searches);
        searches.clear();
      }
      for (SetSearch& search : searches) {
        // Apparent outliers without a discrepancy may be part of one.
        const bool all = search.outliers() == excluded_;
        if (all || search.best() > best - kWorthDiscrepancies) look_alongside(search);
      }
    }
    sort_by_weight(comparison_);
  }

  ModelComparison& comparison() { return comparison_; }

 private:
  void look_alongside_likeliest(std::deque<SetSearch>& searches) {
    auto order = numbers_below(searches.size());
    stable_sort(order, descending([&](std::size_t k) { return searches[k].best(); }));
    order.resize(std::min(order.size(), options_.search.sets_given));
    for (const std::size_t k : order) look_alongside(searches[k]);
  }

  void look_alongside(SetSearch& search) {
    const bool first = comparison_.kernels.empty();
    const bool all_again = options_.search.of_a_cause > 0;
    const Indices kernels = !first && !all_again ? best_kernels(comparison_)
                            : !options_.kernels.empty()
                                ? options_.kernels
                                : numbers_below(system_.discrepancies->kernels.size());
    const std::vector<double> weight = search.run_given_discrepancies(kernels);
    if (first) comparison_.kernels = by_weight(kernels, weight);
  }

  const RegressorSystem& system_;
  const Flags& excluded_;
  const ComparisonOptions& options_;
  ModelComparison comparison_;
};

}  // namespace

Indices best_kernels(const ModelComparison& comparison) {
  Indices likeliest = comparison.kernels;
  likeliest.resize(std::min(likeliest.size(), kBestKernels));
  return likeliest;
}

ModelComparison compare_models(const RegressorSystem& system, const Flags& excluded,
                               const ComparisonOptions& options) {
  Comparer comparer(system, excluded, options);
  auto sets = outlier_sets(system, excluded, first_hypotheses(system, excluded, options));
  if (!contains(sets, excluded)) sets.push_back(excluded);
  comparer.compare_with(sets);
  const auto more = sets_without_links(system, excluded, comparer.comparison());
  if (!more.empty()) comparer.compare_with(more);
  return std::move(comparer.comparison());
}

}  // namespace chaintrue::grid::diagnosis
