// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_comparison.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "grid/diagnosis/model_collector.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// A pattern over the places, and half of it over the visits where it changes with these as well.
struct Kernel {
  double length_mm;
  double visits;  ///< 0: it does not
};
/// From twice the usual distance of two places to a quarter of a frame; over the visits of a row.
constexpr std::array kKernels = {
    Kernel{150.0, 0.0}, Kernel{300.0, 0.0}, Kernel{600.0, 0.0}, Kernel{300.0, 6.0}, Kernel{600.0, 6.0}};
/// In sigmas: from what is hardly seen to what real frames leave, four times over.
constexpr std::array kStrengths = {6.0, 12.0, 24.0, 48.0};
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

double log_share(std::size_t strength) {
  // A half-Cauchy density in steps of equal ratio (discrepancy.hpp).
  const auto weight = [](double s) { return s / (1.0 + std::pow(s / kDiscrepancyScale, 2)); };
  double all = 0.0;
  for (const double s : kStrengths) all += weight(s);
  return std::log(weight(kStrengths.at(strength)) / all / kKernels.size());
}

double bell(double away, double length) {
  const double in_lengths = away / length;
  // Beyond six lengths there is nothing: e^-18.
  return std::abs(in_lengths) < 6.0 ? std::exp(-0.5 * in_lengths * in_lengths) : 0.0;
}

/// Of what is added to a belt at two points.
double alike(const BeltsAnalysis& a, std::size_t k, std::size_t l, const Kernel& kernel) {
  const model::FramePoint p = a.state.frame.state.places[k];
  const model::FramePoint q = a.state.frame.state.places[l];
  const double by_place = bell(std::hypot(p.x_mm - q.x_mm, p.y_mm - q.y_mm), kernel.length_mm);
  const auto& first = a.belts.points[k].order;
  const auto& second = a.belts.points[l].order;
  if (kernel.visits == 0.0 || !first || !second) return by_place;
  return 0.5 * (by_place + bell(*first - *second, kernel.visits));
}

/// (1) of the kept rows for s = 1 mm, in units of noise.
Eigen::MatrixXd covariance_of(const BeltsAnalysis& a,
                              const std::vector<Eigen::Index>& kept,
                              const Kernel& kernel) {
  const auto n = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd checks(4, n);
  std::vector<std::size_t> point;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index row = kept[static_cast<std::size_t>(i)];
    point.push_back(static_cast<std::size_t>(row / 2));
    checks.col(i) = a.linear.checks[point.back()].col(row % 2) / a.sigma_mm;
  }
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      covariance(i, j) = covariance(j, i) =
          checks.col(i).dot(checks.col(j)) *
          alike(a, point[static_cast<std::size_t>(i)], point[static_cast<std::size_t>(j)], kernel);
    }
  }
  return covariance;
}

/// Adds of each cause the places that explain most of `e`.
void add_best(const LinearisedSystem& system,
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
std::vector<int> columns_to_try(const LinearisedSystem& system, const MarginalisedSystem& space) {
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
  return sets_in(a) && sets_in(b) &&
         std::abs(a.values.back() - b.values.back()) <= kAboutOneVisit;
}

/// V = L L' of a pattern in the kept rows.
struct Pattern {
  Eigen::LLT<Eigen::MatrixXd> root;
  double log_det = 0.0;
};

Pattern pattern_of(const Eigen::MatrixXd& covariance, double trace, double strength) {
  Eigen::MatrixXd v = covariance * (strength * strength / std::max(trace, 1e-300));
  v.diagonal().array() += 1.0;
  Pattern pattern{Eigen::LLT<Eigen::MatrixXd>(v), 0.0};
  pattern.log_det =
      2.0 * Eigen::MatrixXd(pattern.root.matrixL()).diagonal().array().log().sum();
  return pattern;
}

/// Trace of the covariance once the anchors have taken their share.
double trace_of(const Eigen::MatrixXd& covariance, const CovarianceRoot& root) {
  return root.solve(root.solve(covariance).transpose()).trace();
}

/// Sets of causes beside one pattern.
class Search {
 public:
  Search(const BeltsAnalysis& a, std::size_t number, const std::vector<int>& columns)
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

  std::vector<CandidateModel> run_beside(const Pattern& pattern, int number, double log_share) {
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

  void prepare(const Pattern& pattern) {
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

  void extend(const ColumnSet& parent, std::set<ColumnSet>& seen, std::vector<WeighedSet>& children) {
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

  const LinearisedSystem& system_;
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
  const LinearisedSystem& system = a.linear.system;
  for (const auto& set : sets)
    comparison.marginalised_systems.push_back(marginalise(system, set, a.analysis.options.steps));
  std::vector<std::pair<double, std::size_t>> best;
  const auto take = [&](std::vector<CandidateModel> models) {
    std::move(models.begin(), models.end(), std::back_inserter(comparison.models));
  };
  std::vector<std::vector<int>> columns;
  for (std::size_t number = 0; number < sets.size(); ++number) {
    columns.push_back(columns_to_try(system, comparison.marginalised_systems[number]));
    auto models = Search(a, number, columns.back()).run_alone();
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
    for (std::size_t l = choice.kernel_step / 2; l < kKernels.size(); l += choice.kernel_step) {
      const Eigen::MatrixXd covariance = covariance_of(a, space.kept, kKernels.at(l));
      const double trace = trace_of(covariance, space.root);
      for (std::size_t s = choice.strength_step - 1; s < kStrengths.size();
           s += choice.strength_step) {
        take(Search(a, number, columns[number])
                 .run_beside(pattern_of(covariance, trace, kStrengths.at(s)),
                             static_cast<int>(l * kStrengths.size() + s),
                             log_share(s)));
      }
    }
  }
  sort_and_sum(comparison);
}

void integrate_pattern(BeltsAnalysis& a) {
  Analysis& own = a.analysis;
  Decision& decision = own.decision;
  if (!decision.discrepancy_left || decision.best_discrepancy < 0) return;
  MarginalisedSystem& space = own.comparison.marginalised_systems[decision.marginalised];
  const auto which = static_cast<std::size_t>(decision.best_discrepancy);
  const Kernel& kernel = kKernels.at(which / kStrengths.size());
  a.pattern_length_mm = kernel.length_mm;
  const Eigen::MatrixXd covariance = covariance_of(a, space.kept, kernel);
  const double trace = trace_of(covariance, space.root);
  const Pattern pattern = pattern_of(covariance, trace, kStrengths.at(which % kStrengths.size()));
  LinearisedSystem& system = own.system;
  const auto whiten = [&](auto&& columns) {
    Eigen::MatrixXd kept = columns(space.kept, Eigen::all);
    pattern.root.matrixL().solveInPlace(kept);
    columns(space.kept, Eigen::all) = kept;
  };
  Eigen::MatrixXd e = system.e;
  whiten(e);
  system.e = e;
  whiten(system.by_setting);
  Eigen::MatrixXd g = system.g.dense();
  whiten(g);
  system.g = RegressorColumns(std::move(g));
  space = marginalise(system, space.outliers, own.options.steps);
  own.estimate = estimate(system, space, decision.regressors, -1);
  const Eigen::VectorXd beside = own.estimate.left(space.kept);
  // Of what anchors and causes leave the pattern takes (V - I) V^-1; L^-1 of it is at hand.
  const Eigen::VectorXd all = pattern.root.matrixL() * beside;
  const Eigen::VectorXd taken = all - pattern.root.matrixU().solve(beside);
  a.pattern_rms_mm =
      a.sigma_mm * std::sqrt(taken.squaredNorm() / static_cast<double>(taken.size()));
  a.pattern_share = std::min(1.0, taken.squaredNorm() / std::max(all.squaredNorm(), 1e-300));
  decision.discrepancy_left = false;
  decision.best_discrepancy = -1;
}

}  // namespace chaintrue::grid::diagnosis
