// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/model_collector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {

namespace {

/// The set with one more column.
ColumnSet with_column(ColumnSet set, Index column) {
  set.insert(std::lower_bound(set.begin(), set.end(), column), column);
  return set;
}

/// It acts from one visit on.
bool sets_in_at_a_visit(const Regressor& r) {
  return r.values.size() == 2 && r.cause.effect->parameters.back().integer &&
         !r.cause.effect->at_one_visit;
}

}  // namespace

bool compatible(const Regressor& a, const Regressor& b, const SearchLimits& limits) {
  if (limits.one_event_visits > 0.0 && a.sets_in() && b.sets_in() &&
      std::abs(a.values.back() - b.values.back()) <= limits.one_event_visits) {
    return false;
  }
  // Effects that set in at one visit of one chain are one event: a skip with a compensating shift
  // is just the shift.
  if (sets_in_at_a_visit(a) && sets_in_at_a_visit(b) && a.cause.side == b.cause.side &&
      a.values.back() == b.values.back())
    return false;
  if (a.cause.effect != b.cause.effect) return true;
  const auto joint = [](EffectSide s) {
    return s == EffectSide::both || s == EffectSide::all || s == EffectSide::none;
  };
  return a.cause.side != b.cause.side && !joint(a.cause.side) && !joint(b.cause.side);
}

double score_alone(const Regressor& regressor, double c, double square) {
  return regressor.fixed ? 2.0 * c - square : c * c / square;
}

ModelCollector::ModelCollector(const RegressorSystem& system, ModelComparison& comparison,
                               const SearchLimits& limits)
    : system_(system),
      comparison_(comparison),
      number_(comparison.marginalised_systems.size() - 1),
      limits_(limits),
      noise_(system.noise_dof, marginalised().kept.size()),
      best_(kMinusInfinity) {}

double ModelCollector::consider(const ColumnSet& set, int discrepancy,
                                const NormalEquations& equations) {
  const SetEvidence evidence = set_evidence(equations, system_.regressors, set, noise_);
  if (!std::isfinite(evidence.log_evidence)) return kMinusInfinity;
  CandidateModel model;
  for (const Index i : set) {
    model.regressors.push_back(equations.columns[as_size(i)]);
  }
  sort(model.regressors);
  model.discrepancy = discrepancy;
  model.marginalised = number_;
  model.log_weight = evidence.log_evidence + log_prior_of(model.regressors, discrepancy);
  model.larger_noise = evidence.larger_noise;
  best_ = std::max(best_, model.log_weight);
  const double weight = model.log_weight;
  if (keeps(set.size(), discrepancy, weight)) comparison_.models.push_back(std::move(model));
  return weight;
}

bool ModelCollector::keeps(std::size_t size, int discrepancy, double weight) const {
  // The model without causes and single causes without a discrepancy are needed later, however
  // unlikely.
  const bool asked_for = discrepancy < 0 && size <= 1;
  return weight > best_ - kNegligibleModel || asked_for;
}

double ModelCollector::log_prior_of(const RegressorSet& regressors, int discrepancy) const {
  double value = marginalised().log_outliers + log_prior(system_, regressors, discrepancy >= 0);
  if (discrepancy >= 0) value += system_.discrepancies->log_share_of(discrepancy);
  return value;
}

void GrowingSets::weigh(const ColumnSet& set) {
  if (known_.insert(set).second)
    weighed_[set.size()].push_back({collector_.consider(set, discrepancy_, equations_), set});
}

bool GrowingSets::fits(const ColumnSet& set, Index column) const {
  return all_of(set, [&](Index other) {
    return compatible(regressor(column), regressor(other), collector_.limits());
  });
}

void GrowingSets::grow(std::size_t size, const GrowthLimits& limits,
                       const std::function<ColumnSet(const ColumnSet&)>& extensions) {
  for (; size < kMostCauses; ++size) {
    std::vector<WeighedSet> parents = weighed_[size];
    std::erase_if(parents, [&](const WeighedSet& own) {
      return !limits.impossible && !std::isfinite(own.weight);
    });
    keep_best(parents, limits.parents, &WeighedSet::weight);
    if (parents.empty() || parents.front().weight < collector_.best() - kGrowWithin) return;
    for (const WeighedSet& parent : parents) {
      for (const Index column : extensions(parent.set)) {
        if (fits(parent.set, column)) weigh(with_column(parent.set, column));
      }
    }
  }
}

void search_by_beam(const NormalEquations& equations, int discrepancy, ModelCollector& collector) {
  // Number of sets of none, one, two and three causes that are extended.
  constexpr std::array<std::size_t, kMostCauses> kExtended = {1, 12, 6, 4};
  const GrowingSets sets(equations, discrepancy, collector);
  collector.consider({}, discrepancy, equations);
  const EvidenceBounds bounds(equations, collector.system().regressors, collector.noise());
  std::vector<WeighedSet> parents = {{0.0, {}}};
  for (std::size_t size = 1; size <= kMostCauses; ++size) {
    const std::size_t extended = size < kMostCauses ? kExtended.at(size) : 0;
    std::vector<WeighedSet> children;
    std::multiset<double> heaviest;  // weights of those to extend
    std::set<ColumnSet> found;
    for (const WeighedSet& parent : parents) {
      const ArrayXd most = bounds.with_each(parent.set);
      std::map<std::pair<bool, bool>, double> prior;  // of one more, by its kind
      for (const Index i : each_below(equations.ge.size())) {
        const Regressor& own = sets.regressor(i);
        const auto [known, is_new] = prior.try_emplace({own.expected, own.slip});
        if (is_new) {
          RegressorSet regressors = {equations.columns[as_size(i)]};
          for (const Index other : parent.set)
            regressors.push_back(equations.columns[as_size(other)]);
          known->second = collector.log_prior_of(regressors, discrepancy) - own.log_prior;
        }
        const double at_most = most(i) + known->second + own.log_prior;
        const bool may_be_extended =
            extended > 0 && (heaviest.size() < extended || at_most >= *heaviest.begin());
        if (!may_be_extended && !collector.keeps(size, discrepancy, at_most)) continue;
        if (!sets.fits(parent.set, i)) continue;
        ColumnSet set = with_column(parent.set, i);
        if (!found.insert(set).second) continue;
        const double weight = collector.consider(set, discrepancy, equations);
        if (!std::isfinite(weight)) continue;
        children.push_back({weight, std::move(set)});
        heaviest.insert(weight);
        if (heaviest.size() > extended) heaviest.erase(heaviest.begin());
      }
    }
    stable_sort(children, descending(&WeighedSet::weight));
    if (children.size() > extended) children.resize(extended);
    parents = std::move(children);
  }
}

}  // namespace chaintrue::grid::diagnosis
