// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

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
  for (const auto& [set, own] : weight) order.emplace_back(-own, set);
  sort(order);
  std::vector<RegressorSet> sets = {{}};
  const auto add = [&](const RegressorSet& set) {
    if (sets.size() < kMostSets && !contains(sets, set)) sets.push_back(set);
  };
  constexpr double kHardly = 0.01;
  for (const auto& [minus, set] : order) {
    if (-minus < kHardly) break;
    add(set);
    for (std::size_t k = 0; set.size() > 1 && k < set.size(); ++k) {
      RegressorSet fewer = set;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      add(fewer);
    }
  }
  return sets;
}

/// A point of a curve, and its weight without its prior in the first contexts.
struct WeighedPoint {
  double at = 0.0;
  double weight = kMinusInfinity;
};

class LawSearch {
 public:
  LawSearch(const Analysis& a, std::size_t number, std::vector<LawCurve> curves)
      : sets_(leading_sets(a)), system_(a, number, sets_), curves_(std::move(curves)) {
    look_without_a_law();
  }

  LawEvidence run(std::size_t number) && {
    look_at_all();
    for (const std::size_t curve : leading_) refine(curve);
    LawEvidence result;
    result.marginalised = number;
    if (!without_.empty()) {
      result.without_set = without_.front().set;
      result.without_discrepancy = without_.front().discrepancy;
    }
    result.log_without = log_without_ + std::log1p(-kLawPrior);
    result.laws = look_again();
    result.curves = std::move(curves_);
    result.sets = std::move(sets_);
    return result;
  }

 private:
  void look_without_a_law() {
    std::vector<std::pair<double, LawContext>> all;
    std::vector<double> weights;
    for (int discrepancy = -1; discrepancy < system_.family().count(); ++discrepancy) {
      const NormalEquations equations = system_.equations(discrepancy);
      for (std::size_t set = 0; set < system_.sets(); ++set) {
        const double own = system_.log_weight(equations, {set, discrepancy}, {});
        if (!std::isfinite(own)) continue;
        weights.push_back(own);
        all.emplace_back(-own, LawContext{set, discrepancy});
      }
    }
    log_without_ = log_sum(weights);
    sort(all);
    for (const auto& [minus, context] : all) {
      if (without_.size() == kMostContexts / 2 || minus > all.front().first + kContextsWithin)
        break;
      without_.push_back(context);
    }
    choose_first(all);
  }

  /// Nothing, the leading sets, and the best two kernels.
  void choose_first(const std::vector<std::pair<double, LawContext>>& all) {
    first_ = {{0, -1}};
    Indices kernels;
    for (const auto& [minus, context] : all) {
      if (first_.size() == kFirstContexts) break;
      if (context == first_.front()) continue;
      if (context.discrepancy >= 0) {
        const std::size_t kernel = system_.family().kernel_of(context.discrepancy);
        const bool known = contains(kernels, kernel);
        if (kernels.size() == 2 || known) continue;
        kernels.push_back(kernel);
        system_.prepare(context.discrepancy);
      }
      first_.push_back(context);
    }
  }

  /// Weights of points in the first contexts, without their priors.
  std::vector<double> weights_of(const std::vector<LawPoint>& points) {
    std::vector<double> weights;
    for (auto from = points.begin(); from != points.end();) {
      auto to = from;
      for (Index count = 0; to != points.end(); ++to) {
        count += columns_of(to->curve->shape);
        if (count > kChunk) break;
      }
      const std::vector<ColumnSet> of_point = system_.take({from, to});
      std::vector<std::vector<double>> terms(of_point.size());
      for (const LawContext& context : first_) {
        const NormalEquations equations = system_.equations(context.discrepancy);
        for (std::size_t k = 0; k < of_point.size(); ++k) {
          if (system_.shows(of_point[k]))
            terms[k].push_back(system_.log_weight(equations, context, of_point[k]));
        }
      }
      for (const auto& own : terms) weights.push_back(log_sum(own));
      from = to;
    }
    return weights;
  }

  void look_at_all() {
    std::vector<LawPoint> all;
    for (const LawCurve& curve : curves_) {
      for (const double at : curve.grid) all.push_back({&curve, at});
    }
    const std::vector<double> weights = weights_of(all);
    auto weight = weights.begin();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const LawCurve& curve = curves_[c];
      points_.emplace_back();
      for (const double at : curve.grid) points_[c].push_back({at, *weight++});
      std::vector<double> terms;
      for (std::size_t k = 0; k < points_[c].size(); ++k)
        terms.push_back(points_[c][k].weight + std::log(curve.mass[k]));
      const double own = log_sum(terms) + std::log(kLawPrior * curve.share);
      if (std::isfinite(own)) order.emplace_back(-own, c);
    }
    sort(order);
    for (const auto& [minus, c] : order) {
      if (leading_.size() == kMostCurves || minus > order.front().first + kLawsWithin) break;
      leading_.push_back(c);
    }
  }

  /// Points between those of the grid about the heaviest, twice.
  void refine(std::size_t c) {
    LawCurve& curve = curves_[c];
    if (!is_continuous(curve.shape)) return;
    std::vector<WeighedPoint>& points = points_[c];
    for (int pass = 0; pass < 2; ++pass) {
      const auto best = max_element(points, ascending(&WeighedPoint::weight));
      std::vector<LawPoint> finer;
      const auto between = [&](double from, double to) {
        for (int k = 1; k < kFiner; ++k) finer.push_back({&curve, from + (to - from) * k / kFiner});
      };
      // The second pass uses the neighbours from the first.
      const auto at = best - points.begin();
      const auto last = static_cast<std::ptrdiff_t>(points.size()) - 1;
      for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(at - 1 - pass, 0);
           k < std::min(at + 1 + pass, last); ++k) {
        between(points[as_size(k)].at, points[as_size(k) + 1].at);
      }
      if (finer.empty()) return;
      const std::vector<double> weights = weights_of(finer);
      for (std::size_t k = 0; k < finer.size(); ++k) points.push_back({finer[k].at, weights[k]});
      sort(points, ascending(&WeighedPoint::at));
    }
    curve.grid.clear();
    for (const WeighedPoint& point : points) curve.grid.push_back(point.at);
    curve.mass = trapezoids(curve);
  }

  /// Prior of each grid point; the sum is one.
  static std::vector<double> trapezoids(const LawCurve& curve) {
    const std::vector<double>& at = curve.grid;
    std::vector<double> mass(at.size(), 0.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double before = k > 0 ? at[k] - at[k - 1] : 0.0;
      const double behind = k + 1 < at.size() ? at[k + 1] - at[k] : 0.0;
      mass[k] = density_at(curve, at[k]) * (before + behind);
      sum += mass[k];
    }
    for (double& own : mass) own /= sum;
    return mass;
  }

  /// The points of leading curves with a share of the weight.
  struct Chosen {
    std::size_t curve = 0;
    std::size_t point = 0;
    ColumnSet columns;
    double log_prior = 0.0;
    double first_weight = 0.0;
  };

  std::vector<Chosen> choose() {
    std::vector<Chosen> chosen;
    for (const std::size_t c : leading_) {
      const LawCurve& curve = curves_[c];
      for (std::size_t k = 0; k < points_[c].size(); ++k) {
        const double prior = std::log(kLawPrior * curve.share * curve.mass[k]);
        if (std::isfinite(points_[c][k].weight))
          chosen.push_back({c, k, {}, prior, prior + points_[c][k].weight});
      }
    }
    stable_sort(chosen, descending(&Chosen::first_weight));
    constexpr std::size_t kMostPoints = 240;
    std::size_t count = 0;
    while (count < std::min(chosen.size(), kMostPoints) &&
           chosen[count].first_weight > chosen.front().first_weight - kLawsWithin) {
      ++count;
    }
    chosen.resize(count);
    return chosen;
  }

  void take(std::vector<Chosen>& chosen) {
    std::vector<LawPoint> points;
    for (const Chosen& own : chosen)
      points.push_back({&curves_[own.curve], points_[own.curve][own.point].at});
    std::vector<ColumnSet> columns = system_.take(points);
    for (std::size_t k = 0; k < chosen.size(); ++k) chosen[k].columns = std::move(columns[k]);
  }

  /// Contexts with a share of the weight given one of the best laws, or without a law.
  std::vector<LawContext> contexts_with(const std::vector<Chosen>& chosen) {
    std::vector<Chosen> best;
    for (const Chosen& own : chosen) {
      const bool known =
          any_of(best, [&](const Chosen& other) { return other.curve == own.curve; });
      if (!known && best.size() < 3) best.push_back(own);
    }
    take(best);
    std::map<LawContext, double> weight;
    for (int discrepancy = -1; discrepancy < system_.family().count(); ++discrepancy) {
      const NormalEquations equations = system_.equations(discrepancy);
      for (std::size_t set = 0; set < system_.sets(); ++set) {
        for (const Chosen& own : best) {
          const double w =
              system_.log_weight(equations, {set, discrepancy}, own.columns) + own.log_prior;
          auto& known = weight.try_emplace({set, discrepancy}, w).first->second;
          known = std::max(known, w);
        }
      }
    }
    std::vector<std::pair<double, LawContext>> order;
    for (const auto& [context, w] : weight) order.emplace_back(-w, context);
    sort(order);
    std::vector<LawContext> contexts;
    for (const auto& [minus, context] : order) {
      if (contexts.size() == kMostContexts || minus > order.front().first + kContextsWithin) break;
      contexts.push_back(context);
    }
    for (const LawContext& context : without_) {
      if (!contains(contexts, context)) contexts.push_back(context);
    }
    sort(contexts,
         ascending([](const LawContext& own) { return std::pair(own.discrepancy, own.set); }));
    return contexts;
  }

  std::vector<WeighedLaw> look_again() {
    std::vector<Chosen> chosen = choose();
    if (chosen.empty()) return {};
    const std::vector<LawContext> contexts = contexts_with(chosen);
    take(chosen);
    std::vector<WeighedLaw> laws(chosen.size());
    std::vector<std::vector<double>> terms(chosen.size());
    std::vector<double> best(chosen.size(), kMinusInfinity);
    std::optional<NormalEquations> equations;
    int of = std::numeric_limits<int>::min();
    for (const LawContext& context : contexts) {
      if (of != context.discrepancy) equations = system_.equations(of = context.discrepancy);
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        const double w = system_.log_weight(*equations, context, chosen[k].columns);
        terms[k].push_back(w);
        if (!(w > best[k])) continue;
        best[k] = w;
        laws[k].set = context.set;
        laws[k].discrepancy = context.discrepancy;
        const LawAmplitudes own = system_.amplitudes(*equations, context, chosen[k].columns);
        laws[k].amplitude = own.value;
        laws[k].covariance = own.covariance;
      }
    }
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      laws[k].curve = chosen[k].curve;
      laws[k].at = points_[chosen[k].curve][chosen[k].point].at;
      laws[k].log_weight = log_sum(terms[k]) + chosen[k].log_prior;
    }
    std::erase_if(laws, [](const WeighedLaw& law) { return !std::isfinite(law.log_weight); });
    stable_sort(laws, descending(&WeighedLaw::log_weight));
    return laws;
  }

  std::vector<RegressorSet> sets_;
  LawSystem system_;
  std::vector<LawCurve> curves_;
  double log_without_ = 0.0;
  std::vector<LawContext> first_;    ///< of the first look
  std::vector<LawContext> without_;  ///< that lead without a law
  std::vector<std::vector<WeighedPoint>> points_;
  Indices leading_;
};

}  // namespace

double LawEvidence::log_total() const {
  std::vector<double> terms = {log_without};
  for (const WeighedLaw& law : laws) terms.push_back(law.log_weight);
  return log_sum(terms);
}

LawEvidence weigh_laws(const Analysis& analysis, std::size_t marginalised,
                       std::vector<LawCurve> curves) {
  return LawSearch(analysis, marginalised, std::move(curves)).run(marginalised);
}

}  // namespace chaintrue::grid::diagnosis
