// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/model_collector.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/diagnosis/discrepancy_basis.hpp"
#include "grid/diagnosis/model_comparison.hpp"
#include "grid/parallel.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// A discrepancy with its evidence before the search.
struct Scouted {
  int discrepancy = 0;
  double weight = kMinusInfinity;
  /// Regressors worth trying in it, with the weight of each alone, best first.
  ScoredRegressors singles;
};

/// With the regressors of more sets, ascending.
RegressorSet with_sets(RegressorSet set, const std::vector<RegressorSet>& more) {
  for (const RegressorSet& own : more) append_all(set, own);
  sort_unique(set);
  return set;
}

class Scout {
 public:
  Scout(const NormalEquations& plain, const std::vector<RegressorSet>& best_models,
        const ModelCollector& collector)
      : plain_(plain), best_models_(best_models), collector_(collector) {
    for (const int k : plain.columns) {
      prior_.push_back(collector.log_prior_of({k}, -1) + std::log(kDiscrepancyPrior));
    }
    prior_of_nothing_ = collector.log_prior_of({}, -1) + std::log(kDiscrepancyPrior);
  }

  /// `given` covers the columns that this scout knows.
  Scouted look_at(const DiscrepancyBasis::GivenKernel& given, int discrepancy) const {
    const auto d = given.diagonal(family().strength_of(discrepancy));
    const double share = family().log_share_of(discrepancy) - 0.5 * d.log_det;
    Scouted result{
        discrepancy, prior_of_nothing_ + share + collector_.noise().log_density(d.ee), {}};
    ScoredRegressors all;
    for (const auto k : each_index(plain_.columns)) {
      all.emplace_back(prior_[k] + share + single(d, as_index(k)), plain_.columns[k]);
    }
    keep_best(all, kSinglesGivenDiscrepancy);
    if (!all.empty()) result.weight = std::max(result.weight, all.front().first);
    result.singles = std::move(all);
    if (best_models_.empty()) return result;
    const NormalEquations equations =
        given.equations(family().strength_of(discrepancy), with_sets({}, best_models_));
    for (const RegressorSet& set : best_models_) {
      result.weight = std::max(result.weight, together(equations, discrepancy, set));
    }
    return result;
  }

 private:
  const DiscrepancyFamily& family() const { return *collector_.system().discrepancies; }

  /// log evidence of one regressor, without the common determinants and ignoring its bounds.
  double single(const DiscrepancyBasis::GivenKernel::Diagonal& d, Index k) const {
    const Regressor& own = collector_.system().regressor(plain_.columns[as_size(k)]);
    const NoiseDensity& noise = collector_.noise();
    if (own.fixed) return noise.log_density_as_stated(d.ee - 2.0 * d.ge(k) + d.gg(k));
    const double gg = std::max(d.gg(k), 0.0);
    const double strength = plain_.prior_square(k) * d.ge(k) * d.ge(k) / std::max(gg * gg, 1e-12);
    // The prior under which the size that fits is the likelier one.
    const bool usual = strength < 8.0 * kUsualSignalToNoise * kUsualSignalToNoise;
    const double sigma = usual ? kUsualSignalToNoise : kWideSignalToNoise;
    const double precision = plain_.prior_square(k) / (sigma * sigma);
    const double q = d.ee - d.ge(k) * d.ge(k) / (gg + precision);
    return noise.log_density_as_stated(std::max(q, 0.0)) - 0.5 * std::log1p(gg / precision);
  }

  double together(const NormalEquations& equations, int discrepancy,
                  const RegressorSet& set) const {
    return set_evidence(equations, collector_.system().regressors, equations.positions(set),
                        collector_.noise())
               .log_evidence +
           collector_.log_prior_of(set, discrepancy);
  }

  const NormalEquations& plain_;
  const std::vector<RegressorSet>& best_models_;
  const ModelCollector& collector_;
  std::vector<double> prior_;
  double prior_of_nothing_ = 0.0;
};

/// The sets given one discrepancy, with full weights: `best_models`, and those grown from singles.
void search_given(const NormalEquations& equations, int discrepancy, const RegressorSet& singles,
                  const std::vector<RegressorSet>& best_models, ModelCollector& collector) {
  GrowingSets sets(equations, discrepancy, collector);
  const ColumnSet alone = equations.positions(singles);
  sets.weigh({});
  for (const Index column : alone) sets.weigh({column});
  for (const RegressorSet& regressors : best_models) sets.weigh(equations.positions(regressors));
  sets.grow(1, {.parents = kBeamGivenDiscrepancy, .impossible = true},
            [&](const ColumnSet&) { return alone; });
}

/// The first `most` of each cause, and those that tie with the last of these.
RegressorSet first_of_each_cause(const RegressorSystem& system, const ScoredRegressors& sorted,
                                 std::size_t most) {
  RegressorSet result;
  std::map<CauseId, std::vector<double>> taken;
  for (const auto& [score, k] : sorted) {
    std::vector<double>& scores = taken[system.regressor(k).cause];
    if (scores.size() >= most && !tied(score, scores[most - 1])) continue;
    scores.push_back(score);
    result.push_back(k);
  }
  return result;
}

/// The best places of each cause alone, and all leading ones.
RegressorSet columns_to_scout(const RegressorSystem& system, const NormalEquations& plain,
                              const std::vector<RegressorSet>& best_models) {
  ScoredRegressors scored;
  for (const auto k : each_index(plain.columns)) {
    const auto at = as_index(k);
    const double gain =
        score_alone(system.regressor(plain.columns[k]), plain.ge(at), plain.gg(at, at));
    scored.emplace_back(gain, plain.columns[k]);
  }
  stable_sort(scored, descending(&ScoredRegressors::value_type::first));
  return with_sets(first_of_each_cause(system, scored, 4), best_models);
}

/// Only the best places of each cause.
RegressorSet worth_trying(const RegressorSystem& system, Scouted scouted) {
  std::erase_if(scouted.singles, [&](const auto& single) {
    return single.first < scouted.weight - kNegligibleModel;
  });
  return first_of_each_cause(system, scouted.singles, 2);
}

/// Those with a share of the weight, best first.
std::vector<int> worth_searching(std::vector<Scouted> scouted) {
  keep_best(scouted, kMostDiscrepanciesSearched, &Scouted::weight);
  std::vector<int> result;
  for (const Scouted& one : scouted) {
    if (one.weight < scouted.front().weight - kDiscrepanciesWithin) break;
    result.push_back(one.discrepancy);
  }
  return result;
}

/// A separate beam search for every discrepancy.
std::vector<double> search_all_by_beam(DiscrepancyBasis& basis, const NormalEquations& plain,
                                       const Indices& kernels, ModelCollector& collector) {
  const DiscrepancyFamily& family = *collector.system().discrepancies;
  const std::size_t step = collector.limits().strength_step;
  const std::size_t strengths = family.strengths.size();
  for (const std::size_t kernel : kernels) {
    const DiscrepancyBasis::GivenKernel given = basis.given(kernel, plain);
    for (std::size_t s = step - 1; s < strengths; s += step) {
      const auto discrepancy = as_int(kernel * strengths + s);
      search_by_beam(given.equations(family.strength_of(discrepancy), plain.columns), discrepancy,
                     collector);
    }
  }
  // All are tried with every set of outliers.
  return std::vector<double>(kernels.size(), 0.0);
}

}  // namespace

std::vector<double> search_given_discrepancies(const NormalEquations& plain,
                                               const std::vector<RegressorSet>& best_models,
                                               const Indices& kernels, ModelCollector& collector) {
  const RegressorSystem& system = collector.system();
  MarginalisedSystem& marginalised = collector.marginalised();
  DiscrepancyBasis basis(system, marginalised, kernels);
  if (collector.limits().of_a_cause > 0)
    return search_all_by_beam(basis, plain, kernels, collector);
  const NormalEquations few =
      normal_equations(system, marginalised, columns_to_scout(system, plain, best_models));
  const Scout first_look(few, best_models, collector);
  const DiscrepancyFamily& family = *system.discrepancies;
  const auto strengths = as_int(family.strengths.size());
  std::vector<Scouted> scouted(kernels.size() * family.strengths.size());
  std::vector<double> of_kernel(kernels.size(), kMinusInfinity);
  basis.relate(few);
  for_each_index(kernels.size(), [&](std::size_t k) {
    const DiscrepancyBasis::GivenKernel given = basis.given(kernels[k], few);
    for (const int strength : each_below(strengths)) {
      Scouted& own = scouted[k * family.strengths.size() + as_size(strength)];
      own = first_look.look_at(given, as_int(kernels[k]) * strengths + strength);
      of_kernel[k] = std::max(of_kernel[k], own.weight);
    }
  });
  const Scout closer_look(plain, best_models, collector);
  std::map<std::size_t, DiscrepancyBasis::GivenKernel> all_columns;
  for (const int discrepancy : worth_searching(std::move(scouted))) {
    const std::size_t kernel = family.kernel_of(discrepancy);
    if (!all_columns.contains(kernel)) all_columns.emplace(kernel, basis.given(kernel, plain));
    const DiscrepancyBasis::GivenKernel& given = all_columns.at(kernel);
    const RegressorSet singles = worth_trying(system, closer_look.look_at(given, discrepancy));
    search_given(given.equations(family.strength_of(discrepancy), with_sets(singles, best_models)),
                 discrepancy, singles, best_models, collector);
  }
  return of_kernel;
}

}  // namespace chaintrue::grid::diagnosis
