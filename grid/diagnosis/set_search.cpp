// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/set_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kMinusInfinity = -std::numeric_limits<double>::infinity();

/// May two regressors act together: one cause acts at one place, and an effect that acts on both
/// chains alike not also on one of them.
bool compatible(const Regressor& a, const Regressor& b) {
  if (a.cause.effect != b.cause.effect) return true;
  using model::effects::EffectSide;
  const auto joint = [](EffectSide s) { return s == EffectSide::both || s == EffectSide::none; };
  return a.cause.side != b.cause.side && !joint(a.cause.side) && !joint(b.cause.side);
}

}  // namespace

class SetSearch::Search {
 public:
  Search(const LinearisedSystem& system,
         MarginalisedSystem& marginalised,
         std::size_t number,
         const ComparisonOptions& options)
      : system_(system),
        marginalised_(marginalised),
        number_(number),
        options_(options),
        noise_(options.steps.anchor_noise ? system.noise_dof : 1e-3,
               static_cast<Eigen::Index>(marginalised.kept.size())) {}

  std::vector<CandidateModel> run() {
    equations_ = normal_equations(marginalised_, columns());
    consider({}, -1, equations_, 0.0);
    singles();
    if (!options_.told) {
      pairs();
      grow();
    }
    return std::move(models_);
  }

  /// The best sets once more, with a discrepancy that nobody knows beside them.
  std::vector<CandidateModel> run_beside_discrepancies() {
    models_.clear();
    beside_discrepancies();
    return std::move(models_);
  }

  [[nodiscard]] double best() const { return best_; }

 private:
  /// Regressors worth their place: those of no whole number, and of the others the best, alone or
  /// once one of the leading regressors has taken its share.
  [[nodiscard]] std::vector<int> columns() const {
    std::vector<int> kept;
    std::vector<int> fixed;
    const auto count = static_cast<int>(system_.regressors.size());
    const Eigen::VectorXd c = marginalised_.g.transpose() * marginalised_.e;
    const Eigen::VectorXd square = marginalised_.g.colwise().squaredNorm();
    for (int k = 0; k < count; ++k) {
      const Regressor& d = system_.regressors[static_cast<std::size_t>(k)];
      if (options_.told && !(d.cause == *options_.told)) continue;
      if (!(square(k) > kLeastSquare)) continue;
      (d.fixed ? fixed : kept).push_back(k);
    }
    if (fixed.size() <= kKeptFixed) {
      kept.insert(kept.end(), fixed.begin(), fixed.end());
      return kept;
    }
    std::vector<int> leading = kept;
    std::stable_sort(leading.begin(), leading.end(), [&](int a, int b) {
      return c(a) * c(a) / square(a) > c(b) * c(b) / square(b);
    });
    leading.resize(std::min<std::size_t>(leading.size(), 8));
    const Eigen::MatrixXd cross =
        marginalised_.g(Eigen::all, fixed).transpose() * marginalised_.g(Eigen::all, leading);
    std::vector<std::pair<double, int>> gains;
    for (std::size_t f = 0; f < fixed.size(); ++f) {
      const int k = fixed[f];
      double best = 2.0 * c(k) - square(k);
      for (std::size_t l = 0; l < leading.size(); ++l) {
        const double ll = square(leading[l]);
        const double x = cross(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(l));
        best = std::max(best, 2.0 * (c(k) - x * c(leading[l]) / ll) - (square(k) - x * x / ll));
      }
      gains.emplace_back(-best, k);
    }
    std::sort(gains.begin(), gains.end());
    for (std::size_t i = 0; i < kKeptFixed; ++i) kept.push_back(gains[i].second);
    return kept;
  }

  /// Weighs a set (positions in the normal equations) and keeps it where it matters.
  double consider(const std::vector<Eigen::Index>& set,
                  int discrepancy,
                  const NormalEquations& equations,
                  double log_discrepancy) {
    std::vector<int> chosen;
    for (const Eigen::Index i : set)
      chosen.push_back(equations.columns[static_cast<std::size_t>(i)]);
    const SetEvidence evidence = set_evidence(equations, system_.regressors, set, noise_);
    if (!std::isfinite(evidence.log_evidence)) return kMinusInfinity;
    CandidateModel model;
    model.regressors = chosen;
    std::sort(model.regressors.begin(), model.regressors.end());
    model.discrepancy = discrepancy;
    model.marginalised = number_;
    model.log_weight = evidence.log_evidence + marginalised_.log_outliers + log_discrepancy +
                       prior(chosen, discrepancy >= 0);
    model.larger_noise = noise_.larger_share(evidence.quadratic);
    model.quadratic = evidence.quadratic;
    best_ = std::max(best_, model.log_weight);
    if (model.log_weight > best_ - kNegligibleModel || set.size() <= 1) models_.push_back(model);
    return model.log_weight;
  }

  [[nodiscard]] double prior(const std::vector<int>& set, bool discrepancy) const {
    double value = log_prior(system_.regressors, set, discrepancy);
    if (!options_.steps.average_location) {
      for (const int k : set) value -= system_.regressors[static_cast<std::size_t>(k)].log_prior;
    }
    return value;
  }

  void singles() {
    for (std::size_t k = 0; k < equations_.columns.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      const double weight = consider({at}, -1, equations_, 0.0);
      scored_.push_back({weight, {at}});
    }
  }

  /// Upper bound of a pair's weight but for what bounds and larger noise add.
  [[nodiscard]] double quick_weight(Eigen::Index i, Eigen::Index j) const {
    const Regressor& a = regressor(i);
    const Regressor& b = regressor(j);
    const double aa = equations_.gg(i, i);
    const double bb = equations_.gg(j, j);
    double q = equations_.ee;
    double ca = equations_.ge(i);
    double cb = equations_.ge(j);
    const double ab = equations_.gg(i, j);
    double occam = 0.0;
    const double precision = 1.0 / (kWideSignalToNoise * kWideSignalToNoise);
    if (a.fixed && b.fixed) {
      q += aa + bb + 2.0 * (ab - ca - cb);
    } else if (a.fixed || b.fixed) {
      const double ff = a.fixed ? aa : bb;
      const double cf = a.fixed ? ca : cb;
      const double oo = a.fixed ? bb : aa;
      const double co = (a.fixed ? cb : ca) - ab;
      q += ff - 2.0 * cf - co * co / (oo * (1.0 + precision));
      occam = std::log(kUsualSignalToNoise);
    } else {
      ca /= std::sqrt(aa);
      cb /= std::sqrt(bb);
      const double collinearity = ab / std::sqrt(aa * bb);
      const double one = 1.0 + precision;
      const double det = one * one - collinearity * collinearity;
      q -= (one * (ca * ca + cb * cb) - 2.0 * collinearity * ca * cb) / det;
      occam = 2.0 * std::log(kUsualSignalToNoise) + 0.5 * std::log(det);
    }
    const auto n = static_cast<double>(marginalised_.kept.size());
    return -0.5 * (n + system_.noise_dof) * std::log(system_.noise_dof + std::max(q, 0.0)) -
           occam + a.log_prior + b.log_prior;
  }

  void pairs() {
    const auto count = static_cast<Eigen::Index>(equations_.columns.size());
    std::vector<std::pair<double, std::pair<Eigen::Index, Eigen::Index>>> quick;
    double best = kMinusInfinity;
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        if (!compatible(regressor(i), regressor(j))) continue;
        const double weight = quick_weight(i, j);
        if (weight < best - kPairsWithin) continue;
        best = std::max(best, weight);
        quick.push_back({weight, {j, i}});
      }
    }
    std::stable_sort(
        quick.begin(), quick.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t k = 0; k < quick.size(); ++k) {
      if (quick[k].first < best - kPairsWithin || k > kMostPairs) break;
      const std::vector<Eigen::Index> set = {quick[k].second.first, quick[k].second.second};
      scored_.push_back({consider(set, -1, equations_, 0.0), set});
    }
  }

  void grow() {
    for (std::size_t size = 3; size <= kMostCauses; ++size) {
      std::vector<Scored> parents;
      for (const Scored& s : scored_) {
        if (s.set.size() == size - 1 && std::isfinite(s.weight)) parents.push_back(s);
      }
      std::stable_sort(parents.begin(), parents.end(), heavier);
      if (parents.empty() || parents.front().weight < best_ - kGrowWithin) return;
      if (parents.size() > kBeam) parents.resize(kBeam);
      std::set<std::vector<Eigen::Index>> seen;
      for (const Scored& parent : parents) extend(parent.set, seen);
    }
  }

  void extend(const std::vector<Eigen::Index>& parent, std::set<std::vector<Eigen::Index>>& seen) {
    // What the parent leaves, and of each regressor: a score for the cost of one inner product.
    const Eigen::MatrixXd own = equations_.gg(parent, parent);
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(own);
    const Eigen::VectorXd left =
        equations_.ge - equations_.gg(Eigen::all, parent) * ldlt.solve(equations_.ge(parent));
    std::vector<std::pair<double, Eigen::Index>> order;
    for (Eigen::Index i = 0; i < left.size(); ++i) {
      bool fits = true;
      for (const Eigen::Index p : parent) fits = fits && compatible(regressor(i), regressor(p));
      if (!fits) continue;
      const Eigen::VectorXd x = equations_.gg(parent, i);
      const double square = equations_.gg(i, i) - x.dot(ldlt.solve(x));
      if (!(square > 1e-6 * equations_.gg(i, i))) continue;
      const double gain = regressor(i).fixed ? 2.0 * left(i) - square : left(i) * left(i) / square;
      order.emplace_back(-gain - 2.0 * regressor(i).log_prior, i);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t k = 0; k < std::min(order.size(), kChildren); ++k) {
      std::vector<Eigen::Index> set = parent;
      set.push_back(order[k].second);
      std::sort(set.begin(), set.end());
      if (!seen.insert(set).second) continue;
      scored_.push_back({consider(set, -1, equations_, 0.0), set});
    }
  }

  void beside_discrepancies() {
    std::stable_sort(scored_.begin(), scored_.end(), heavier);
    std::vector<std::vector<Eigen::Index>> sets = {{}};
    std::vector<int> used;
    std::array<std::size_t, kMostCauses + 1> taken{};
    std::vector<CauseId> alone;
    for (const Scored& s : scored_) {
      const bool single = s.set.size() == 1;
      const CauseId cause = regressor(s.set.front()).cause;
      // Every cause alone at its best places, and the best of the others.
      const auto times = std::count(alone.begin(), alone.end(), cause);
      if (single ? times >= 2 : taken[s.set.size()] >= kBesideDiscrepancy / 2) continue;
      if (single) alone.push_back(cause);
      ++taken[s.set.size()];
      sets.push_back(s.set);
      for (const Eigen::Index i : s.set) {
        used.push_back(equations_.columns[static_cast<std::size_t>(i)]);
      }
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const std::vector<NormalEquations> by_discrepancy =
        normal_equations_beside_discrepancies(system_, marginalised_, used);
    for (int discrepancy = 0; discrepancy < kDiscrepancies; ++discrepancy) {
      const NormalEquations& equations = by_discrepancy[static_cast<std::size_t>(discrepancy)];
      const double share = log_share_of_discrepancy(discrepancy);
      for (const auto& set : sets) {
        std::vector<Eigen::Index> there;
        for (const Eigen::Index i : set) {
          there.push_back(equations.position(equations_.columns[static_cast<std::size_t>(i)]));
        }
        consider(there, discrepancy, equations, share);
      }
    }
  }

  struct Scored {
    double weight;
    std::vector<Eigen::Index> set;
  };
  static bool heavier(const Scored& a, const Scored& b) { return a.weight > b.weight; }

  [[nodiscard]] const Regressor& regressor(Eigen::Index i) const {
    return system_
        .regressors[static_cast<std::size_t>(equations_.columns[static_cast<std::size_t>(i)])];
  }

  static constexpr double kLeastSquare = 1e-8;

  const LinearisedSystem& system_;
  MarginalisedSystem& marginalised_;
  std::size_t number_;
  const ComparisonOptions& options_;
  NoiseDensity noise_;
  NormalEquations equations_;
  std::vector<CandidateModel> models_;
  std::vector<Scored> scored_;
  double best_ = kMinusInfinity;
};

SetSearch::SetSearch(const LinearisedSystem& system,
                     MarginalisedSystem& marginalised,
                     std::size_t number,
                     const ComparisonOptions& options)
    : search_(std::make_unique<Search>(system, marginalised, number, options)) {}
SetSearch::~SetSearch() = default;
SetSearch::SetSearch(SetSearch&&) noexcept = default;
SetSearch& SetSearch::operator=(SetSearch&&) noexcept = default;
std::vector<CandidateModel> SetSearch::run() { return search_->run(); }
std::vector<CandidateModel> SetSearch::run_beside_discrepancies() {
  return search_->run_beside_discrepancies();
}
double SetSearch::best() const { return search_->best(); }

}  // namespace chaintrue::grid::diagnosis
