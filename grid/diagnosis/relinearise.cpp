// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/analysis.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kRounds = 8;
constexpr double kConverged = 1e-3;           // of a size: a hundredth of its sigma at strength 10
constexpr double kConvergedSettingMm = 1e-3;  // of a setting
constexpr int kSteps = 5;                     // of the search for a size
constexpr double kLongestStep = 0.5;          // of a size

bool has_continuous_place(const Regressor& regressor) {
  const auto& parameters = regressor.cause.effect->parameters;
  return parameters.size() > 1 && !parameters.back().integer;
}

/// Distance of the farther one of the two places next to a regressor's own: phases are cyclic.
double reach(const RegressorSystem& system, const Regressor& own) {
  double below = 0.0;
  double above = 0.0;
  for (const Regressor& d : system.regressors) {
    if (d.cause != own.cause) continue;
    const double step = d.values.back() - own.values.back();
    if (step < 0.0 && (below == 0.0 || -step < below)) below = -step;
    if (step > 0.0 && (above == 0.0 || step < above)) above = step;
  }
  return std::max(below, above);
}

class Round {
 public:
  Round(const ObservationSet& session, const State& state, const RegressorSystem& system,
        MarginalisedSystem marginalised, int discrepancy)
      : session_(session), state_(state), system_(system), marginalised_(std::move(marginalised)) {
    const auto all = numbers_below<int>(system.regressors.size());
    g_ = reduced(marginalised_, system.g.dense(all));
    estimate_ = diagnosis::estimate(system, marginalised_, all, discrepancy);
  }
  const Estimate& estimate() const { return estimate_; }

  /// The size whose signature, projected on the current one, has the length that the coefficient
  /// needs.
  double size(std::size_t which) const {
    const Regressor& own = system_.regressors[which];
    const auto& bounds = own.cause.effect->parameters.front();
    const double asked = estimate_.coefficient(as_index(which));
    const auto bounded = [&](double s) { return std::clamp(s, bounds.lower, bounds.upper); };
    double last = own.values.front();
    double last_length = 1.0;
    double now = bounded(size_at(own, asked));
    for (int step = 0; step < kSteps; ++step) {
      const auto there = length(which, now);
      if (!there || now == last) break;
      const double slope = (*there - last_length) / (now - last);
      if (std::abs(*there - asked) < 0.1 * kConverged || !(std::abs(slope) > 0.0)) break;
      const double most = kLongestStep * std::abs(now);
      const double change = std::clamp((asked - *there) / slope, -most, most);
      last = now;
      last_length = *there;
      now = bounded(now + change);
    }
    return now;
  }

  /// The place at which a cause explains most, given the others.
  double place(std::size_t which, double reach) const {
    const Regressor& own = system_.regressors[which];
    double low = own.values.back() - reach;
    double high = own.values.back() + reach;
    if (own.cause.effect->law != nullptr) {
      // A formula is known to be finite only between its bounds.
      const auto& bounds = own.cause.effect->parameters.back();
      low = std::max(low, bounds.lower);
      high = std::min(high, bounds.upper);
    }
    const auto gain = gain_given_others(which);
    constexpr double kGolden = 0.381966011250105;
    double x1 = low + kGolden * (high - low);
    double x2 = high - kGolden * (high - low);
    double f1 = gain(x1);
    double f2 = gain(x2);
    for (int step = 0; step < 18; ++step) {
      if (f1 > f2) {
        high = x2;
        x2 = x1;
        f2 = f1;
        x1 = low + kGolden * (high - low);
        f1 = gain(x1);
      } else {
        low = x1;
        x1 = x2;
        f1 = f2;
        x2 = high - kGolden * (high - low);
        f2 = gain(x2);
      }
    }
    return 0.5 * (low + high);
  }

 private:
  std::optional<double> length(std::size_t which, double size) const {
    SizedCause there = system_.regressors[which];
    there.values.front() = size;
    const auto g = column(there);
    if (!g) return std::nullopt;
    const auto own = g_.col(as_index(which));
    return own.dot(*g) / own.squaredNorm();
  }

  /// R^-1 of a signature.
  std::optional<VectorXd> column(const SizedCause& cause) const {
    const auto g = signature(session_, state_, system_, cause);
    if (!g) return std::nullopt;
    return reduced(marginalised_, *g);
  }

  /// What a regressor explains by its place, after projection on the others.
  std::function<double(double)> gain_given_others(std::size_t which) const {
    auto all_others = numbers_below<Index>(g_.cols());
    std::erase(all_others, as_index(which));
    const MatrixXd others = g_(Eigen::all, all_others);
    const auto without = [gram = linear::PivotedCholesky(linear::gram(others)),
                          others](VectorXd v) {
      if (others.cols() > 0) {
        linear::add_product(v, -1.0, others, gram.solve(linear::inner(others, v)));
      }
      return v;
    };
    return [this, which, without, e = without(marginalised_.e)](double place) {
      SizedCause there = system_.regressors[which];
      there.values.back() = place;
      const auto g = column(there);
      if (!g) return 0.0;
      const VectorXd left = without(*g);
      const double square = left.squaredNorm();
      const double c = left.dot(e);
      const double sign = estimate_.coefficient(as_index(which));
      return square > 1e-12 && c * sign > 0.0 ? c * c / square : 0.0;
    };
  }

  const ObservationSet& session_;
  const State& state_;
  const RegressorSystem& system_;
  MarginalisedSystem marginalised_;
  MatrixXd g_;  ///< the regressors' reduced columns
  Estimate estimate_;
};

}  // namespace

void relinearise(Analysis& a) {
  const ObservationSet& session = a.session;
  const RegressorSystem& system = a.system;
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const int discrepancy = a.decision.discrepancy_left ? a.decision.best_discrepancy : -1;
  std::vector<Regressor> own;
  std::vector<double> reaches;
  for (const int k : a.decision.regressors) {
    own.push_back(system.regressor(k));
    reaches.push_back(reach(system, own.back()));
  }
  for (int round = 0; round < kRounds; ++round) {
    auto about = linearise(session, a.state);
    if (!about || !renew_regressors(session, a.state, own, *about)) break;
    MarginalisedSystem there = marginalise(*about, marginalised.outliers);
    there.discrepancy_trace = marginalised.discrepancy_trace;  // the discrepancy keeps its strength
    const Round here(session, a.state, *about, std::move(there), discrepancy);
    const Index settings = session.setting_columns();
    bool converged = here.estimate().setting_change.head(settings).lpNorm<Eigen::Infinity>() <
                     kConvergedSettingMm;
    std::vector<Regressor> moved = own;
    for (const auto k : each_index(own)) {
      if (own[k].fixed) continue;
      moved[k].values.front() = here.size(k);
      converged = converged && std::abs(moved[k].values.front() - own[k].values.front()) <
                                   kConverged * std::abs(own[k].values.front());
      // With a discrepancy the best of the places tried is used, because e contains the
      // discrepancy.
      if (has_continuous_place(own[k]) && discrepancy < 0)
        moved[k].values.back() = here.place(k, reaches[k]);
    }
    auto next = moved_to(session, a.state, about->setting + here.estimate().setting_change);
    if (!next) break;
    a.state = *std::move(next);
    own = std::move(moved);
    if (converged) break;
  }
  a.known.clear();
  for (const auto k : each_index(own)) {
    const double first = system.regressor(a.decision.regressors[k]).values.front();
    // A secant over a tiny size has no direction.
    if (own[k].fixed || !(std::abs(own[k].values.front()) > kConverged * std::abs(first))) continue;
    a.known.push_back({own[k].cause, own[k].values});
  }
}

}  // namespace chaintrue::grid::diagnosis
