// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interp/symmetric_eigen.hpp"

namespace chaintrue::interp::reml {
namespace {

// Ten decades either side of balance: beyond, the penalty (or the data) is below the rounding of
// the other.
constexpr double kHalfRange = 23.0;
constexpr double kScanStep = 3.0;
constexpr double kLongestStep = 4.0;
// V is of order one near its minimum; a gradient of 1e-7 moves theta by about 1e-7 of its sigma.
constexpr double kGradientTolerance = 1e-7;

struct Limits {
  Eigen::VectorXd low;
  Eigen::VectorXd high;
};

Limits limits_of(const Marginal& marginal) {
  const Eigen::Index n = marginal.unknowns();
  Limits limits{Eigen::VectorXd::Constant(n, -kHalfRange),
                Eigen::VectorXd::Constant(n, kHalfRange)};
  for (Eigen::Index k = 0; k < marginal.penalties(); ++k) {
    limits.low(k) += marginal.balanced_log_lambda(k);
    limits.high(k) += marginal.balanced_log_lambda(k);
  }
  if (marginal.sigma2_free()) {
    // Noise below 1e-5 of the responses cannot be distinguished from the rounding of a leverage
    // near one.
    const double largest = std::log(marginal.response_variance());
    limits.low(n - 1) = std::min(largest - kHalfRange, 0.0);
    limits.high(n - 1) = std::max(largest, 0.0) + 1.0;
  }
  return limits;
}

double value_at(const Marginal& marginal, const Eigen::VectorXd& theta) {
  const auto state = marginal.evaluate(theta, Order::value);
  return state ? state->value : std::numeric_limits<double>::infinity();
}

// All lambdas are moved together over the range, and sigma2 below the responses' variance where it
// is unknown; the best of them starts the search.
Eigen::VectorXd scan(const Marginal& marginal,
                     const Eigen::VectorXd& balance,
                     const Limits& limits) {
  const Eigen::Index k = marginal.penalties();
  std::vector<double> log_sigma2 = {0.0};
  if (marginal.sigma2_free() && !marginal.noise_from_repeats()) {
    const double largest = std::log(marginal.response_variance());
    log_sigma2 = {largest, largest - 5.0, largest - 10.0, largest - 15.0};
  }
  Eigen::VectorXd best = balance;
  double best_value = std::numeric_limits<double>::infinity();
  for (const double s : log_sigma2) {
    for (double offset = -15.0; offset <= 15.0; offset += kScanStep) {
      Eigen::VectorXd theta = balance;
      theta.head(k).array() += offset;
      if (marginal.sigma2_free()) {
        theta.head(k).array() -= s;
        theta(k) = s;
      }
      theta = theta.cwiseMax(limits.low).cwiseMin(limits.high);
      const double value = value_at(marginal, theta);
      if (value < best_value) {
        best_value = value;
        best = theta;
      }
    }
  }
  return best;
}

std::vector<bool> held_at_limit(const Eigen::VectorXd& theta,
                                const Eigen::VectorXd& gradient,
                                const Limits& limits) {
  std::vector<bool> held(static_cast<std::size_t>(theta.size()), false);
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    held[static_cast<std::size_t>(i)] = (theta(i) <= limits.low(i) && gradient(i) > 0.0) ||
                                        (theta(i) >= limits.high(i) && gradient(i) < 0.0);
  }
  return held;
}

// Newton's step with the Hessian's eigenvalues made positive, no longer than kLongestStep.
Eigen::VectorXd newton_step(const State& state, const std::vector<bool>& held) {
  Eigen::MatrixXd hessian = state.hessian;
  Eigen::VectorXd gradient = state.gradient;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    if (held[static_cast<std::size_t>(i)]) {
      hessian.row(i).setZero();
      hessian.col(i).setZero();
      hessian(i, i) = 1.0;
      gradient(i) = 0.0;
    }
  }
  const SymmetricEigen solver(hessian);
  const double floor = 1e-8 * std::max(1.0, solver.eigenvalues().cwiseAbs().maxCoeff());
  const Eigen::VectorXd curvature = solver.eigenvalues().cwiseAbs().cwiseMax(floor);
  Eigen::VectorXd step = -(solver.eigenvectors() *
                           (solver.eigenvectors().transpose() * gradient).cwiseQuotient(curvature));
  const double longest = step.cwiseAbs().maxCoeff();
  return longest > kLongestStep ? Eigen::VectorXd(step * (kLongestStep / longest)) : step;
}

// Far out V approaches its limit slowly: a flat gradient there is a boundary, not a minimum.
SmoothingEnd end_of(double theta, double low, double high, double curvature) {
  constexpr double kFlat = 1e-4;
  const double middle = 0.5 * (low + high);
  if (theta >= high || (curvature < kFlat && theta > middle)) {
    return SmoothingEnd::stiff;
  }
  if (theta <= low || (curvature < kFlat && theta < middle)) {
    return SmoothingEnd::interpolate;
  }
  return SmoothingEnd::inside;
}

double largest_free_gradient(const Eigen::VectorXd& gradient, const std::vector<bool>& held) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    if (!held[static_cast<std::size_t>(i)]) {
      largest = std::max(largest, std::abs(gradient(i)));
    }
  }
  return largest;
}

// V determines theta only to the square root of its rounding; its gradient to its own. Near a minimum
// Newton's steps continue as long as the gradient decreases.
void polish(const Marginal& marginal, const Limits& limits, Eigen::VectorXd& theta, State& state) {
  constexpr int kMostSteps = 4;
  constexpr double kNear =
      1e-2;  // longer steps creep along a V that is flat, or leave another one's minimum
  for (int i = 0; i < kMostSteps; ++i) {
    const std::vector<bool> held = held_at_limit(theta, state.gradient, limits);
    const Eigen::VectorXd step = newton_step(state, held);
    if (step.cwiseAbs().maxCoeff() > kNear) return;
    const Eigen::VectorXd next = (theta + step).cwiseMax(limits.low).cwiseMin(limits.high);
    auto there = marginal.evaluate(next, Order::hessian);
    if (!there ||
        largest_free_gradient(there->gradient, held_at_limit(next, there->gradient, limits)) >=
            largest_free_gradient(state.gradient, held)) {
      return;
    }
    theta = next;
    state = *std::move(there);
  }
}

}  // namespace

tl::expected<SearchResult, FitFailure::Reason> search(const Marginal& marginal,
                                                      int maximum_iterations) {
  const Limits limits = limits_of(marginal);
  SearchResult result;
  result.low = limits.low;
  result.high = limits.high;
  Eigen::VectorXd balance = 0.5 * (limits.low + limits.high);
  if (marginal.sigma2_free()) {
    balance(balance.size() - 1) = 0.0;
  }
  if (!marginal.evaluate(balance, Order::value)) {
    return tl::unexpected(FitFailure::Reason::rank_deficient);
  }
  result.theta = scan(marginal, balance, limits);
  auto state = marginal.evaluate(result.theta, Order::hessian);
  if (!state) return tl::unexpected(FitFailure::Reason::rank_deficient);
  bool converged = false;
  while (!converged) {
    const std::vector<bool> held = held_at_limit(result.theta, state->gradient, limits);
    if (largest_free_gradient(state->gradient, held) < kGradientTolerance) {
      break;
    }
    if (result.iterations == maximum_iterations) {
      return tl::unexpected(FitFailure::Reason::not_converged);
    }
    ++result.iterations;
    Eigen::VectorXd step = newton_step(*state, held);
    double fraction = 1.0;
    Eigen::VectorXd next;
    // Halve until V decreases; if it does not, the rounding of V is reached.
    for (; fraction > 1e-6; fraction *= 0.5) {
      next = (result.theta + fraction * step).cwiseMax(limits.low).cwiseMin(limits.high);
      if (value_at(marginal, next) < state->value) {
        break;
      }
    }
    converged = fraction <= 1e-6;
    if (!converged) {
      const double before = state->value;
      result.theta = next;
      state = marginal.evaluate(result.theta, Order::hessian);
      if (!state) return tl::unexpected(FitFailure::Reason::rank_deficient);
      // Changes of V below 1e-10 are negligible; where its gradient is all rounding it never gets
      // small.
      converged = before - state->value < 1e-10;
    }
  }
  // If the gradient itself ended the search there is nothing to refine.
  if (converged) polish(marginal, limits, result.theta, *state);
  for (Eigen::Index k = 0; k < marginal.penalties(); ++k) {
    result.ends.push_back(
        end_of(result.theta(k), limits.low(k), limits.high(k), state->hessian(k, k)));
  }
  return result;
}

Eigen::MatrixXd covariance_from_hessian(const Eigen::MatrixXd& hessian,
                                        const std::vector<SmoothingEnd>& ends) {
  const Eigen::Index n = hessian.rows();
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (k >= ends.size() || ends[k] == SmoothingEnd::inside) {
      free.push_back(i);
    }
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  if (free.empty()) {
    return covariance;
  }
  const Eigen::MatrixXd information = 0.5 * hessian(free, free);
  const SymmetricEigen solver(information);
  // A flat direction would have an unbounded variance: ten decades of lambda are the limit.
  const double floor = 1.0 / (kHalfRange * kHalfRange);
  const Eigen::VectorXd variance = solver.eigenvalues().cwiseMax(floor).cwiseInverse();
  covariance(free, free) =
      solver.eigenvectors() * variance.asDiagonal() * solver.eigenvectors().transpose();
  return covariance;
}

}  // namespace chaintrue::interp::reml
