// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/laws.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/diagnosis/law_system.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

// Limits of the search; weights are logarithms. No verdict may depend on these.
constexpr double kLawsWithin = 9.0;      // below the best: laws that are looked at again
constexpr double kContextsWithin = 7.0;  // below the best: contexts of the second look
constexpr std::size_t kMostSets = 7;
constexpr std::size_t kMostCurves = 60;
constexpr std::size_t kMostContexts = 32;
constexpr std::size_t kFirstContexts = 4;
constexpr Index kChunk = 96;  // columns at once, so that their products stay small
constexpr int kFiner = 4;     // points between two of a grid, at each of two refinements

/// Nothing, the comparison's leading sets, and these without one of their causes.
std::vector<RegressorSet> leading_sets(const Analysis& a) {
  std::map<RegressorSet, double> weight;
  for (const CandidateModel& model : a.comparison.models)
    weight[model.regressors] += a.comparison.probability(model);
  std::vector<std::pair<double, RegressorSet>> order;
  constexpr double kHardly = 0.01;
  for (const auto& [set, own] : weight) {
    if (own >= kHardly) order.emplace_back(-own, set);
  }
  sort(order);
  std::vector<RegressorSet> sets = {{}};
  const auto add = [&](const RegressorSet& set) {
    if (sets.size() < kMostSets && !contains(sets, set)) sets.push_back(set);
  };
  for (const auto& [minus, set] : order) {
    add(set);
    for (std::size_t k = 0; set.size() > 1 && k < set.size(); ++k) {
      RegressorSet fewer = set;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      add(fewer);
    }
  }
  return sets;
}

/// Those with the largest weights, best first: at most `most`, within a distance of the best.
template <class What>
std::vector<What> leading(const std::vector<What>& all, const VectorXd& log_weights,
                          std::size_t most, double within) {
  const auto weight = [&](std::size_t k) { return log_weights(as_index(k)); };
  Indices order = numbers_below(all.size());
  std::erase_if(order, [&](std::size_t k) { return !std::isfinite(weight(k)); });
  stable_sort(order, descending(weight));
  std::vector<What> result;
  for (const std::size_t k : order) {
    if (result.size() == most || weight(k) < weight(order.front()) - within) break;
    result.push_back(all[k]);
  }
  return result;
}

double log_sum_of(const VectorXd& terms) { return log_sum({terms.begin(), terms.end()}); }

class LawSearch {
 public:
  LawSearch(const Analysis& a, std::size_t number, std::vector<LawCurve> curves)
      : sets_(leading_sets(a)),
        system_(a, number, sets_),
        number_(number),
        curves_(std::make_shared<std::vector<LawCurve>>(std::move(curves))) {}

  LawEvidence run() {
    const VectorXd without = system_.log_weights(contexts_, {ColumnSet{}}).col(0);
    without_ = leading(contexts_, without, kMostContexts / 2, kContextsWithin);
    choose_first(leading(contexts_, without, contexts_.size(), kInfinity));
    return {log_sum_of(without) + std::log1p(-kLawPrior), look_again(look_at_all())};
  }

 private:
  /// Nothing, the leading sets, and the best two kernels.
  void choose_first(const std::vector<LawContext>& all) {
    Indices kernels;
    for (const LawContext& context : all) {
      if (first_.size() == kFirstContexts) break;
      if (context == first_.front()) continue;
      if (context.discrepancy >= 0) {
        const std::size_t kernel = system_.family().kernel_of(context.discrepancy);
        if (kernels.size() == 2 || contains(kernels, kernel)) continue;
        kernels.push_back(kernel);
        system_.prepare(context.discrepancy);
      }
      first_.push_back(context);
    }
  }

  /// Weights in the first contexts.
  void weigh(std::vector<LawPoint>& points) {
    for (auto from = points.begin(); from != points.end();) {
      auto to = from;
      for (Index count = 0; to != points.end(); ++to) {
        count += columns_of(to->curve->shape);
        if (count > kChunk) break;
      }
      const MatrixXd weights = system_.log_weights(first_, system_.take({from, to}));
      for (const auto& own : weights.colwise()) (from++)->log_weight = log_sum_of(own);
    }
  }

  /// The points of leading curves with a share of the weight.
  std::vector<LawPoint> look_at_all() {
    std::vector<LawPoint> all;
    for (const LawCurve& curve : *curves_) {
      for (const auto k : each_index(curve.grid))
        all.push_back({{curves_, &curve}, curve.grid[k], curve.mass[k]});
    }
    weigh(all);
    std::vector<std::vector<LawPoint>> of_curve;
    VectorXd weights = VectorXd::Constant(std::ssize(*curves_), kMinusInfinity);
    for (const LawPoint& point : all) {
      if (of_curve.empty() || of_curve.back().front().curve != point.curve) of_curve.emplace_back();
      double& sum = weights(std::ssize(of_curve) - 1);
      of_curve.back().push_back(point);
      sum = log_sum(sum, point.log_weight + point.log_prior());
    }
    std::vector<LawPoint> chosen;
    for (std::vector<LawPoint>& own : leading(of_curve, weights, kMostCurves, kLawsWithin)) {
      refine(own);
      append_all(chosen, own);
    }
    constexpr std::size_t kMostPoints = 240;
    VectorXd of_chosen(std::ssize(chosen));
    for (const auto k : each_index(chosen))
      of_chosen(as_index(k)) = chosen[k].log_prior() + chosen[k].log_weight;
    return leading(chosen, of_chosen, kMostPoints, kLawsWithin);
  }

  /// Points between those of the grid about the heaviest, twice; their priors are trapezoids.
  void refine(std::vector<LawPoint>& points) {
    const LawCurve& curve = *points.front().curve;
    if (!is_continuous(curve.shape) || points.size() < 2) return;
    for (const int pass : each_below(2)) {
      // The second pass uses the neighbours from the first.
      const auto best = max_element(points, ascending(&LawPoint::log_weight)) - points.begin();
      std::vector<LawPoint> finer;
      for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(best - 1 - pass, 0);
           k < std::min(best + 1 + pass, std::ssize(points) - 1); ++k) {
        const double from = points[as_size(k)].at;
        const double to = points[as_size(k) + 1].at;
        for (int step = 1; step < kFiner; ++step)
          finer.push_back({points.front().curve, from + (to - from) * step / kFiner});
      }
      weigh(finer);
      append_all(points, finer);
      sort(points, ascending(&LawPoint::at));
    }
    double sum = 0.0;
    for (const auto k : each_index(points)) {
      LawPoint& own = points[k];
      const double before = k > 0 ? own.at - points[k - 1].at : 0.0;
      const double behind = k + 1 < points.size() ? points[k + 1].at - own.at : 0.0;
      own.mass = density_at(curve, own.at) * (before + behind);
      sum += own.mass;
    }
    for (LawPoint& own : points) own.mass /= sum;
  }

  /// Contexts with a share of the weight given one of the best laws, or without a law.
  std::vector<LawContext> contexts_with(const std::vector<LawPoint>& chosen) {
    std::vector<LawPoint> best;
    for (const LawPoint& own : chosen) {
      const bool known = any_of(best, having(&LawPoint::curve, own.curve));
      if (!known && best.size() < 3) best.push_back(own);
    }
    MatrixXd weights = system_.log_weights(contexts_, system_.take(best));
    for (const auto k : each_index(best)) weights.col(as_index(k)).array() += best[k].log_prior();
    std::vector<LawContext> contexts =
        leading(contexts_, weights.rowwise().maxCoeff(), kMostContexts, kContextsWithin);
    append_all(contexts, without_);
    sort_unique(contexts);
    return contexts;
  }

  ActsBesides besides(const LawContext& context) const {
    return {sets_[context.set], context.discrepancy};
  }

  std::vector<WeighedLaw> look_again(const std::vector<LawPoint>& chosen) {
    std::vector<WeighedLaw> laws;
    if (chosen.empty()) return laws;
    const std::vector<LawContext> contexts = contexts_with(chosen);
    const std::vector<ColumnSet> columns = system_.take(chosen);
    const MatrixXd weights = system_.log_weights(contexts, columns);
    for (const auto k : each_index(chosen)) {
      const LawPoint& own = chosen[k];
      laws.push_back({own, number_});
      laws.back().log_weight = log_sum_of(weights.col(as_index(k))) + own.log_prior();
      if (!without_.empty()) laws.back().without = besides(without_.front());
    }
    for (const Index row : each_below(weights.rows())) {
      const LawContext& context = contexts[as_size(row)];
      for (const auto k : each_index(chosen)) {
        Index best = 0;
        weights.col(as_index(k)).maxCoeff(&best);
        if (best != row) continue;
        laws[k].with = besides(context);
        system_.fit(context, columns[k], laws[k]);
      }
    }
    std::erase_if(laws, [](const WeighedLaw& law) { return !std::isfinite(law.log_weight); });
    stable_sort(laws, descending(&WeighedLaw::log_weight));
    return laws;
  }

  std::vector<RegressorSet> sets_;
  LawSystem system_;
  std::size_t number_;
  std::shared_ptr<const std::vector<LawCurve>> curves_;
  const std::vector<LawContext> contexts_ = system_.contexts();
  std::vector<LawContext> first_ = {LawContext{}};  ///< of the first look
  std::vector<LawContext> without_;                 ///< that lead without a law
};

}  // namespace

LawEvidence weigh_laws(const Analysis& analysis, std::size_t marginalised,
                       std::vector<LawCurve> curves) {
  return LawSearch(analysis, marginalised, std::move(curves)).run();
}

}  // namespace chaintrue::grid::diagnosis
