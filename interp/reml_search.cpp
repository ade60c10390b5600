// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interp/linear_algebra.hpp"

namespace chaintrue::interp::reml {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Ten decades either side of balance: beyond them the ridge (or the data) is below the other's
// rounding.
constexpr double kHalfRange = 23.0;
constexpr double kLongestStep = 4.0;
// V is of order one near its minimum; a gradient of 1e-7 moves theta by about 1e-7 of its sigma.
constexpr double kGradientTolerance = 1e-7;

struct Limits {
  Theta low = Theta::Zero();
  Theta high = Theta::Zero();
  [[nodiscard]] Theta clamp(const Theta& theta) const { return theta.cwiseMax(low).cwiseMin(high); }
};

Limits limits_of(const Likelihood& likelihood) {
  Limits limits;
  if (likelihood.has_ridge()) {
    const double middle = std::log(likelihood.balance());
    limits.low[0] = middle - kHalfRange;
    limits.high[0] = middle + kHalfRange;
  }
  if (likelihood.finds_sigma2()) {
    // Noise below 1e-5 of the responses cannot be distinguished from the rounding of a leverage
    // near one.
    const double largest = std::log(likelihood.response_variance());
    limits.low[1] = std::min(largest - kHalfRange, 0.0);
    limits.high[1] = std::max(largest, 0.0) + 1.0;
  }
  return limits;
}

double value_at(const Likelihood& likelihood, const Theta& theta) {
  const auto state = likelihood.evaluate(theta, Order::value);
  return state ? state->value : kInfinity;
}

// Scans lambda over its range and, if sigma2 is unknown, sigma2 below the responses' variance; the
// best point starts the search.
Theta scan(const Likelihood& likelihood, const Theta& balance, const Limits& limits) {
  constexpr double kReach = 15.0;
  constexpr double kStep = 3.0;
  std::vector<double> log_sigma2 = {0.0};
  if (likelihood.finds_sigma2() && !likelihood.noise_from_repeats()) {
    const double largest = std::log(likelihood.response_variance());
    log_sigma2 = {largest, largest - 5.0, largest - 10.0, largest - 15.0};
  }
  const double reach = likelihood.has_ridge() ? kReach : 0.0;
  Theta best = balance;
  double best_value = kInfinity;
  for (const double s : log_sigma2) {
    for (double offset = -reach; offset <= reach; offset += kStep) {
      const Theta theta = limits.clamp({balance[0] + offset - s, s});
      const double value = value_at(likelihood, theta);
      if (value < best_value) {
        best_value = value;
        best = theta;
      }
    }
  }
  return best;
}

// 1 for an unknown that may move, 0 for one that is given or that V presses against a limit.
Theta free_of(const Theta& theta, const Theta& gradient, const Limits& limits) {
  Theta free = Theta::Ones();
  for (Eigen::Index i = 0; i < 2; ++i) {
    if (limits.low[i] == limits.high[i] || (theta[i] <= limits.low[i] && gradient[i] > 0.0) ||
        (theta[i] >= limits.high[i] && gradient[i] < 0.0)) {
      free[i] = 0.0;
    }
  }
  return free;
}

// Fixed unknowns get a curvature of 1 and no coupling.
Eigen::Matrix2d restricted(const Eigen::Matrix2d& hessian, const Theta& free) {
  Eigen::Matrix2d result = hessian.cwiseProduct(free * free.transpose());
  result.diagonal() += Theta::Ones() - free;
  return result;
}

// Newton's step with the Hessian's eigenvalues made positive, no longer than kLongestStep.
Theta newton_step(const State& state, const Theta& free) {
  const linear::SymmetricEigen solver(restricted(state.hessian, free));
  const double floor = 1e-8 * std::max(1.0, solver.eigenvalues().lpNorm<Eigen::Infinity>());
  const Eigen::VectorXd turned =
      solver.eigenvectors().transpose() * free.cwiseProduct(state.gradient);
  const Theta step = -(solver.eigenvectors() *
                       turned.cwiseQuotient(solver.eigenvalues().cwiseAbs().cwiseMax(floor)));
  const double longest = step.lpNorm<Eigen::Infinity>();
  return longest > kLongestStep ? Theta(step * (kLongestStep / longest)) : step;
}

double largest_free_gradient(const Theta& theta, const State& state, const Limits& limits) {
  return free_of(theta, state.gradient, limits)
      .cwiseProduct(state.gradient)
      .lpNorm<Eigen::Infinity>();
}

// V determines theta only to the square root of V's rounding; the gradient determines it to its own
// rounding. Near a minimum Newton's steps continue as long as the gradient decreases.
void polish(const Likelihood& likelihood, const Limits& limits, Theta& theta, State& state) {
  constexpr int kMostPolishing = 4;
  // Longer steps creep along a flat V or leave the minimum.
  constexpr double kNear = 1e-2;
  for (int i = 0; i < kMostPolishing; ++i) {
    const Theta step = newton_step(state, free_of(theta, state.gradient, limits));
    if (step.lpNorm<Eigen::Infinity>() > kNear) return;
    const Theta next = limits.clamp(theta + step);
    auto there = likelihood.evaluate(next, Order::hessian);
    if (!there || largest_free_gradient(next, *there, limits) >=
                      largest_free_gradient(theta, state, limits)) {
      return;
    }
    theta = next;
    state = *std::move(there);
  }
}

// Far out V approaches its limit slowly: a flat gradient there is a boundary, not a minimum.
bool ends_inside(double theta, double low, double high, double curvature) {
  constexpr double kFlat = 1e-4;
  return theta > low && theta < high && (curvature >= kFlat || theta == 0.5 * (low + high));
}

// One standard error of each theta from the Hessian of V (twice the information).
Theta standard_errors(const SearchResult& found) {
  const bool lambda_inside =
      found.low[0] < found.high[0] &&
      ends_inside(found.theta[0], found.low[0], found.high[0], found.state.hessian(0, 0));
  const linear::SymmetricEigen solver(
      restricted(0.5 * found.state.hessian,
                 {lambda_inside ? 1.0 : 0.0, found.low[1] < found.high[1] ? 1.0 : 0.0}));
  // A flat direction would have an unbounded variance: ten decades of lambda are the limit.
  const Eigen::VectorXd variance =
      solver.eigenvalues().cwiseMax(1.0 / (kHalfRange * kHalfRange)).cwiseInverse();
  Theta sigma = (solver.eigenvectors().cwiseAbs2() * variance).cwiseSqrt();
  if (!lambda_inside) sigma[0] = kInfinity;
  return sigma;
}

// Walks the posterior density.
class Walker {
 public:
  Walker(const Likelihood& likelihood, const SearchResult& found)
      : likelihood_(likelihood),
        found_(found),
        step_(standard_errors(found).cwiseMax(0.2).cwiseMin(1.0)) {}

  std::vector<Likelihood::Node> nodes() {
    for (const double direction : {-1.0, 1.0}) {
      Theta from = found_.theta;
      for (int j = direction < 0.0 ? 0 : 1; j < kLongest; ++j) {
        from[1] = found_.theta[1] + direction * step_[1] * j;
        if (from[1] < found_.low[1] || from[1] > found_.high[1]) break;
        const Likelihood::Node best = along_lambda(from);
        if (!(best.weight > peak_ - kNegligible)) break;
        from[0] = best.theta[0];
      }
    }
    return normalized();
  }

 private:
  static constexpr double kNegligible = 4.0;
  static constexpr int kLongest = 60;

  // The average always includes the prior, so that the posterior is proper; the fit includes it on
  // request.
  [[nodiscard]] double log_density(const State& state, const Theta& theta) const {
    const bool has_prior = likelihood_.prior() == SmoothingPrior::avoids_boundary;
    return -0.5 * (state.value + (has_prior ? 0.0 : likelihood_.flat_slope().dot(theta)));
  }

  // The node of the highest density. Weights are logarithms here.
  Likelihood::Node along_lambda(const Theta& from) {
    Likelihood::Node best{from, -kInfinity};
    for (const double direction : {-1.0, 1.0}) {
      for (int j = direction < 0.0 ? 0 : 1; j < kLongest; ++j) {
        const Theta theta(from[0] + direction * step_[0] * j, from[1]);
        if (theta[0] < found_.low[0] || theta[0] > found_.high[0]) break;
        const auto state = likelihood_.evaluate(theta, Order::value);
        if (!state) break;
        const Likelihood::Node node{theta, log_density(*state, theta)};
        if (node.weight > best.weight) best = node;
        peak_ = std::max(peak_, node.weight);
        if (node.weight < best.weight - kNegligible) break;
        nodes_.push_back(node);
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<Likelihood::Node> normalized() const {
    std::vector<Likelihood::Node> kept;
    double sum = 0.0;
    for (const Likelihood::Node& node : nodes_) {
      if (node.weight <= peak_ - kNegligible) continue;
      kept.push_back({node.theta, std::exp(node.weight - peak_)});
      sum += kept.back().weight;
    }
    for (Likelihood::Node& node : kept) node.weight /= sum;
    return kept;
  }

  const Likelihood& likelihood_;
  const SearchResult& found_;
  Theta step_;
  double peak_ = -kInfinity;
  std::vector<Likelihood::Node> nodes_;
};

}  // namespace

tl::expected<SearchResult, FitReason> search(const Likelihood& likelihood) {
  const auto rank_deficient = tl::unexpected(FitReason::rank_deficient);
  if (likelihood.has_ridge() && !(likelihood.balance() > 0.0)) return rank_deficient;
  const Limits limits = limits_of(likelihood);
  const Theta balance(0.5 * (limits.low[0] + limits.high[0]), 0.0);
  if (!likelihood.evaluate(balance, Order::value)) return rank_deficient;
  Theta theta = scan(likelihood, balance, limits);
  auto state = likelihood.evaluate(theta, Order::hessian);
  if (!state) return rank_deficient;
  bool converged = false;
  for (int iteration = 0; !converged; ++iteration) {
    if (largest_free_gradient(theta, *state, limits) < kGradientTolerance) break;
    if (iteration == kMostSteps) return tl::unexpected(FitReason::not_converged);
    const Theta step = newton_step(*state, free_of(theta, state->gradient, limits));
    double fraction = 1.0;
    Theta next;
    // Halve until V decreases; if it does not, the rounding of V is reached.
    for (; fraction > 1e-6; fraction *= 0.5) {
      next = limits.clamp(theta + fraction * step);
      if (value_at(likelihood, next) < state->value) break;
    }
    converged = fraction <= 1e-6;
    if (!converged) {
      const double before = state->value;
      theta = next;
      state = likelihood.evaluate(theta, Order::hessian);
      if (!state) return rank_deficient;
      // Changes of V below 1e-10 are negligible; where the gradient is dominated by rounding it
      // never gets small.
      converged = before - state->value < 1e-10;
    }
  }
  // If the gradient ended the search there is nothing to refine.
  if (converged) polish(likelihood, limits, theta, *state);
  return SearchResult{theta, limits.low, limits.high, *std::move(state)};
}

std::vector<Likelihood::Node> posterior_nodes(const Likelihood& likelihood,
                                              const SearchResult& found) {
  return Walker(likelihood, found).nodes();
}

}  // namespace chaintrue::interp::reml
