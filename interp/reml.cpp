// SPDX-License-Identifier: GPL-3.0-or-later
// Notation as in reml.hpp; theta is (log lambda, log sigma2).
#include "interp/reml.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "interp/reml_search.hpp"

namespace chaintrue::interp {

PenalisedProblem::PenalisedProblem(Eigen::Index columns)
    : gram(Eigen::MatrixXd::Zero(columns, columns)),
      moment(Eigen::VectorXd::Zero(columns)),
      prior_precision(gram),
      prior_mean(moment) {}

void PenalisedProblem::add_rows(const Eigen::Ref<const Eigen::MatrixXd>& x,
                                const Eigen::Ref<const Eigen::VectorXd>& y) {
  if (x.cols() != columns() || x.rows() != y.size()) {
    throw std::invalid_argument(fmt::format("{} x {} design rows and {} responses for {} columns",
                                            x.rows(),
                                            x.cols(),
                                            y.size(),
                                            columns()));
  }
  linear::add_gram(gram, 1.0, x);
  moment.noalias() += x.transpose() * y;
  response_square += y.squaredNorm();
  rows += x.rows();
  if (keeps_rows) {
    design.conservativeResize(rows, columns());
    design.bottomRows(x.rows()) = x;
    response.conservativeResize(rows);
    response.tail(y.size()) = y;
  }
}

namespace {

tl::unexpected<FitFailure> rank_deficient() {
  return tl::unexpected(FitFailure{
      FitFailure::Reason::rank_deficient,
      "the points do not determine the fit: some combination of its unknowns is left free"});
}

PenalisedFit fit_at(const PenalisedProblem& problem,
                    const reml::Likelihood& likelihood,
                    const reml::Theta& theta,
                    const reml::State& state) {
  PenalisedFit fit;
  fit.coefficients = likelihood.to_columns(state.coefficients);
  fit.covariance = likelihood.covariance({{theta, 1.0}}, state);
  fit.corrected_covariance = fit.covariance;
  fit.lambda = std::exp(theta[0]);
  fit.inverse_lambda = 1.0 / fit.lambda;
  fit.sigma2 = std::exp(theta[1]);
  fit.edf = fit.covariance.cwiseProduct(problem.gram).sum() / fit.sigma2;
  fit.minus_two_log_reml = state.value;
  return fit;
}

}  // namespace

tl::expected<PenalisedFit, FitFailure> fit_penalised(const PenalisedProblem& problem,
                                                     const FitOptions& options) {
  const reml::Likelihood likelihood(problem, options.prior);
  const auto found = reml::search(likelihood);
  if (!found && found.error() == FitReason::rank_deficient) return rank_deficient();
  if (!found) {
    return tl::unexpected(FitFailure{
        found.error(),
        fmt::format("the choice of smoothing did not settle in {} steps", reml::kMostSteps)});
  }
  PenalisedFit fit = fit_at(problem, likelihood, found->theta, found->state);
  if (options.correct_covariance && (likelihood.has_ridge() || likelihood.finds_sigma2())) {
    const auto nodes = reml::posterior_nodes(likelihood, *found);
    fit.corrected_covariance = likelihood.covariance(nodes, found->state);
    fit.inverse_lambda = 0.0;
    for (const auto& node : nodes) fit.inverse_lambda += node.weight * std::exp(-node.theta[0]);
  }
  return fit;
}

tl::expected<PenalisedFit, FitFailure> fit_with_smoothing(const PenalisedProblem& problem,
                                                          double lambda,
                                                          double sigma2) {
  if (!(lambda > 0.0) || !(sigma2 > 0.0)) {
    throw std::invalid_argument(
        fmt::format("a fit with lambda {} and sigma2 {}; both are positive", lambda, sigma2));
  }
  const reml::Theta theta(std::log(lambda), std::log(sigma2));
  // One Cholesky factor costs less than the preparation for many lambdas, if it is accurate enough.
  const reml::Likelihood once(problem, theta);
  if (auto state = once.evaluate(theta, reml::Order::value)) {
    state->value -= static_cast<double>(problem.ridge.count) * theta[0];
    return fit_at(problem, once, theta, *state);
  }
  const reml::Likelihood likelihood(problem, SmoothingPrior::none);
  const auto state = likelihood.evaluate(theta, reml::Order::value);
  if (!state) return rank_deficient();
  return fit_at(problem, likelihood, theta, *state);
}

namespace {

// The Cholesky factor of I - H_gg.
tl::expected<linear::Cholesky, FitFailure> without_group(
    const Eigen::Ref<const Eigen::MatrixXd>& spread, double sigma2) {
  const Eigen::Index m = spread.rows();
  linear::Cholesky factor(Eigen::MatrixXd::Identity(m, m) - spread / sigma2);
  // The rounding of covariance * gram is about 1e-12.
  constexpr double kSmallestPivot = 1e-9;
  if (!factor.is_positive_definite() ||
      factor.lower().diagonal().array().square().minCoeff() < kSmallestPivot) {
    return tl::unexpected(FitFailure{FitFailure::Reason::rank_deficient,
                                     "the other points do not determine the fit without these"});
  }
  return factor;
}

}  // namespace

tl::expected<Eigen::VectorXd, FitFailure> held_out_residual(
    const Eigen::Ref<const Eigen::VectorXd>& residual,
    const Eigen::Ref<const Eigen::MatrixXd>& spread,
    double sigma2) {
  if (spread.rows() != residual.size() || spread.cols() != residual.size()) {
    throw std::invalid_argument(fmt::format("{} held-out residuals with a spread of {} x {}",
                                            residual.size(),
                                            spread.rows(),
                                            spread.cols()));
  }
  return without_group(spread, sigma2).map([&](const linear::Cholesky& factor) {
    return factor.solve(residual);
  });
}

tl::expected<Eigen::VectorXd, FitFailure> held_out_residual_by_root(
    const Eigen::Ref<const Eigen::VectorXd>& residual,
    const Eigen::Ref<const Eigen::MatrixXd>& root,
    double sigma2) {
  if (root.rows() != residual.size()) {
    throw std::invalid_argument(
        fmt::format("{} held-out residuals with a root of {} rows", residual.size(), root.rows()));
  }
  if (root.rows() <= root.cols()) {
    return held_out_residual(residual, linear::outer(root), sigma2);
  }
  // (I - W W' / s2)^-1 = I + W (s2 I - W' W)^-1 W'; one is positive definite if and only if the
  // other is.
  return without_group(linear::gram(root), sigma2).map([&](const linear::Cholesky& factor) {
    return Eigen::VectorXd(residual + root * factor.solve(root.transpose() * residual) / sigma2);
  });
}

}  // namespace chaintrue::interp
