// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_comparison.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "grid/diagnosis/belts_pattern.hpp"
#include "grid/diagnosis/model_collector.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Regressors of a cause that are weighed, the best of its places: alone, and beside what leads.
constexpr std::size_t kOfACause = 3;
/// Of what leads so many are taken out in turn.
constexpr std::size_t kLeading = 3;
/// Sets of one, two and three causes that are extended: a beam, as set_search.hpp has it.
constexpr std::array<std::size_t, kMostCauses> kExtended = {1, 12, 6, 4};
/// Sets of readings set aside that are tried beside patterns.
constexpr std::size_t kMostSets = 2;

/// With more rows a pattern's covariance costs seconds: a coarser choice of them, at the end alone.
constexpr std::size_t kManyRows = 500;

/// Which patterns are looked at: every so many of the kernels and of the strengths.
struct Choice {
  std::size_t sets = 0;
  std::size_t kernel_step = 1;
  std::size_t strength_step = 1;
};
Choice choice_of(Look look, std::size_t rows) {
  if (look == Look::first) return rows > kManyRows ? Choice{} : Choice{1, 1, 2};
  return rows > kManyRows ? Choice{1, 3, 2} : Choice{kMostSets, 1, 1};
}

/// Adds of each cause the places that explain most of `e`.
void add_best(const RegressorSystem& system,
              const Eigen::MatrixXd& g,
              const Eigen::VectorXd& e,
              std::set<int>& chosen) {
  const Eigen::VectorXd c = g.transpose() * e;
  const Eigen::VectorXd square = g.colwise().squaredNorm();
  std::vector<std::pair<double, int>> scores;
  const auto take = [&] {
    std::stable_sort(scores.begin(), scores.end(), [](const auto& x, const auto& y) {
      return x.first > y.first;
    });
    for (std::size_t k = 0; k < std::min(scores.size(), kOfACause); ++k)
      chosen.insert(scores[k].second);
    scores.clear();
  };
  for (std::size_t k = 0; k < system.regressors.size(); ++k) {
    const Regressor& own = system.regressors[k];
    if (k > 0 && !(own.cause == system.regressors[k - 1].cause)) take();
    const auto at = static_cast<Eigen::Index>(k);
    if (!(square(at) > 1e-8)) continue;
    scores.emplace_back(own.fixed ? 2.0 * c(at) - square(at) : c(at) * c(at) / square(at),
                        static_cast<int>(k));
  }
  take();
}

/// The best of each cause's places, once the anchors have taken their share, and once one of what
/// leads has taken its own.
std::vector<int> columns_to_try(const RegressorSystem& system, const MarginalisedSystem& space) {
  std::set<int> chosen;
  const Eigen::MatrixXd all = space.g.dense();
  add_best(system, all, space.e, chosen);
  std::vector<std::pair<double, int>> leading;
  for (const int k : chosen) {
    if (system.regressors[static_cast<std::size_t>(k)].fixed) continue;
    const auto g = space.g.col(k);
    leading.emplace_back(std::abs(g.dot(space.e)) / g.norm(), k);
  }
  std::sort(leading.rbegin(), leading.rend());
  std::vector<CauseId> taken;
  for (const auto& [score, k] : leading) {
    const CauseId& cause = system.regressors[static_cast<std::size_t>(k)].cause;
    if (taken.size() == kLeading) break;
    if (std::find(taken.begin(), taken.end(), cause) != taken.end()) continue;
    taken.push_back(cause);
    const Eigen::VectorXd own = space.g.col(k).normalized();
    const Eigen::MatrixXd g = all - own * (own.transpose() * all);
    add_best(system, g, space.e - own * own.dot(space.e), chosen);
  }
  return {chosen.begin(), chosen.end()};
}

/// One sigma of a regressor's coefficient, from the spread of its parameter.
double coefficient_sigma(const Regressor& regressor) {
  const double ratio = regressor.cause.effect->parameters.front().prior_sigma /
                       std::max(std::abs(regressor.values.front()), 1e-12);
  return std::pow(ratio, regressor.power);
}

/// What sets in at about one visit is one event, whatever it is called: an anchor that slips in a way
/// between those that are tried looks like a skip of another belt as well.
bool one_event(const Regressor& a, const Regressor& b) {
  constexpr double kAboutOneVisit = 4.0;
  const auto sets_in = [](const Regressor& r) { return r.cause.effect->parameters.size() > 1; };
  return sets_in(a) && sets_in(b) && std::abs(a.values.back() - b.values.back()) <= kAboutOneVisit;
}

/// Sets of causes beside one pattern.
class BeltCauseSearch {
 public:
  BeltCauseSearch(const BeltsAnalysis& a, std::size_t number, const std::vector<int>& columns)
      : system_(a.linear.system),
        number_(number),
        space_(a.analysis.comparison.marginalised_systems[number]),
        noise_(system_.noise_dof, static_cast<Eigen::Index>(space_.kept.size())) {
    equations_.columns = columns;
  }

  std::vector<CandidateModel> run_alone() {
    equations_ = normal_equations(space_, std::move(equations_.columns));
    return run();
  }

  std::vector<CandidateModel> run_beside(const PatternNoise& pattern,
                                         int number,
                                         double log_share) {
    prepare(pattern);
    discrepancy_ = number;
    log_share_ = log_share;
    return run();
  }

 private:
  std::vector<CandidateModel> run() {
    equations_.prior_square = equations_.gg.diagonal();
    for (Eigen::Index i = 0; i < equations_.gg.rows(); ++i) {
      const Regressor& own = regressor(i);
      if (own.fixed) continue;
      equations_.prior_square(i) = std::pow(kUsualSignalToNoise / coefficient_sigma(own), 2);
    }
    consider({});
    std::vector<WeighedSet> parents = {{0.0, {}}};
    for (std::size_t size = 1; size <= kMostCauses; ++size) {
      std::vector<WeighedSet> children;
      std::set<ColumnSet> seen;
      for (const WeighedSet& parent : parents) extend(parent.set, seen, children);
      std::stable_sort(children.begin(), children.end(), heavier);
      if (size < kMostCauses && children.size() > kExtended[size]) children.resize(kExtended[size]);
      parents = std::move(children);
    }
    std::erase_if(models_, [&](const CandidateModel& m) {
      // Nothing and single causes without a pattern are asked for later, however unlikely.
      const bool asked_for = m.discrepancy < 0 && m.regressors.size() <= 1;
      return !asked_for && m.log_weight < best_ - kNegligibleModel;
    });
    return std::move(models_);
  }

  void prepare(const PatternNoise& pattern) {
    const auto whitened = [&](Eigen::MatrixXd m) {
      pattern.root.matrixL().solveInPlace(m);
      return m;
    };
    const CovarianceRoot root(whitened(system_.by_setting(space_.kept, Eigen::all)) *
                              system_.sigma.asDiagonal());
    const Eigen::VectorXd e = root.solve(whitened(system_.e(space_.kept)));
    const Eigen::MatrixXd columns = system_.g.dense(equations_.columns);
    const Eigen::MatrixXd g = root.solve(whitened(columns(space_.kept, Eigen::all)));
    equations_.ee = e.squaredNorm();
    equations_.ge = g.transpose() * e;
    equations_.gg = g.transpose() * g;
    equations_.log_det = root.log_det() + pattern.log_det;
  }

  double consider(const ColumnSet& set) {
    const SetEvidence evidence = set_evidence(equations_, system_.regressors, set, noise_);
    if (!std::isfinite(evidence.log_evidence)) return evidence.log_evidence;
    CandidateModel model;
    for (const Eigen::Index i : set)
      model.regressors.push_back(equations_.columns[static_cast<std::size_t>(i)]);
    model.discrepancy = discrepancy_;
    model.marginalised = number_;
    model.log_weight = evidence.log_evidence + space_.log_outliers + log_share_ +
                       log_prior(system_.regressors, model.regressors, discrepancy_ >= 0);
    model.quadratic = evidence.quadratic;
    best_ = std::max(best_, model.log_weight);
    models_.push_back(std::move(model));
    return models_.back().log_weight;
  }

  void extend(const ColumnSet& parent,
              std::set<ColumnSet>& seen,
              std::vector<WeighedSet>& children) {
    for (Eigen::Index i = 0; i < equations_.ge.size(); ++i) {
      const Regressor& own = regressor(i);
      const bool fits = std::all_of(parent.begin(), parent.end(), [&](Eigen::Index other) {
        return compatible(own, regressor(other)) && !one_event(own, regressor(other));
      });
      if (!fits) continue;
      ColumnSet set = parent;
      set.push_back(i);
      std::sort(set.begin(), set.end());
      if (!seen.insert(set).second) continue;
      const double weight = consider(set);
      if (std::isfinite(weight)) children.push_back({weight, std::move(set)});
    }
  }

  [[nodiscard]] const Regressor& regressor(Eigen::Index i) const {
    return system_
        .regressors[static_cast<std::size_t>(equations_.columns[static_cast<std::size_t>(i)])];
  }

  const RegressorSystem& system_;
  std::size_t number_;
  int discrepancy_ = -1;
  const MarginalisedSystem& space_;
  NoiseDensity noise_;
  NormalEquations equations_;
  double log_share_ = 0.0;
  double best_ = -std::numeric_limits<double>::infinity();
  std::vector<CandidateModel> models_;
};

void sort_and_sum(ModelComparison& comparison) {
  std::stable_sort(comparison.models.begin(),
                   comparison.models.end(),
                   [](const auto& x, const auto& y) { return x.log_weight > y.log_weight; });
  std::vector<double> weights;
  for (const CandidateModel& model : comparison.models) weights.push_back(model.log_weight);
  comparison.log_total = log_sum(weights);
}

}  // namespace

void compare_belts(const std::vector<std::vector<bool>>& sets, Look look, BeltsAnalysis& a) {
  ModelComparison& comparison = a.analysis.comparison;
  comparison = {};
  const RegressorSystem& system = a.linear.system;
  for (const auto& set : sets)
    comparison.marginalised_systems.push_back(marginalise(system, set, a.analysis.options.steps));
  std::vector<std::pair<double, std::size_t>> best;
  const auto take = [&](std::vector<CandidateModel> models) {
    std::move(models.begin(), models.end(), std::back_inserter(comparison.models));
  };
  std::vector<std::vector<int>> columns;
  for (std::size_t number = 0; number < sets.size(); ++number) {
    columns.push_back(columns_to_try(system, comparison.marginalised_systems[number]));
    auto models = BeltCauseSearch(a, number, columns.back()).run_alone();
    double most = models.front().log_weight;
    for (const CandidateModel& model : models) most = std::max(most, model.log_weight);
    best.emplace_back(most, number);
    take(std::move(models));
  }
  std::sort(best.rbegin(), best.rend());
  const Choice choice = choice_of(look, system.units.size());
  for (std::size_t k = 0; k < std::min(choice.sets, best.size()); ++k) {
    const std::size_t number = best[k].second;
    const MarginalisedSystem& space = comparison.marginalised_systems[number];
    const std::vector<PatternRow> rows = pattern_rows(a, space.kept);
    for (std::size_t l = choice.kernel_step / 2; l < kPatternKernels; l += choice.kernel_step) {
      const Eigen::MatrixXd covariance = pattern_covariance(rows, rows, l);
      for (std::size_t s = choice.strength_step - 1; s < kPatternStrengths;
           s += choice.strength_step) {
        const auto number_of = static_cast<int>(l * kPatternStrengths + s);
        take(BeltCauseSearch(a, number, columns[number])
                 .run_beside(beside_pattern(covariance, space.root, number_of),
                             number_of,
                             log_share_of_pattern(number_of)));
      }
    }
  }
  sort_and_sum(comparison);
}

}  // namespace chaintrue::grid::diagnosis
