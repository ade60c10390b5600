// SPDX-License-Identifier: GPL-3.0-or-later
// Notation as in reml.hpp; theta is (log lambda, log sigma2).
#include "interp/reml.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "interp/linear_algebra.hpp"
#include "interp/reml_search.hpp"

namespace chaintrue::interp {

PenalisedProblem::PenalisedProblem(Index columns)
    : design(MatrixXd::Zero(0, columns)),
      prior_precision(MatrixXd::Zero(columns, columns)),
      prior_mean(VectorXd::Zero(columns)) {}

void PenalisedProblem::add_rows(const Eigen::Ref<const MatrixXd>& x,
                                const Eigen::Ref<const VectorXd>& y) {
  if (x.cols() != columns() || x.rows() != y.size()) {
    throw std::invalid_argument(fmt::format("{} x {} design rows and {} responses for {} columns",
                                            x.rows(), x.cols(), y.size(), columns()));
  }
  design.conservativeResize(design.rows() + x.rows(), Eigen::NoChange);
  design.bottomRows(x.rows()) = x;
  response.conservativeResize(design.rows());
  response.tail(y.size()) = y;
  rows += x.rows();
}

void PenalisedProblem::add_products(Index count, const MatrixXd& products) {
  const MatrixXd root = linear::PivotedCholesky(products).root(0.0).transpose();
  add_rows(root.leftCols(columns()), root.rightCols(1));
  rows += count - root.rows();
}

namespace {

tl::unexpected<FitFailure> rank_deficient() {
  return tl::unexpected(FitFailure{
      FitFailure::Reason::rank_deficient,
      "the points do not determine the fit: some combination of its unknowns is left free"});
}

PenalisedFit fit_at(const reml::Likelihood& likelihood, const reml::State& state) {
  PenalisedFit fit;
  fit.coefficients = likelihood.coefficients(state);
  fit.covariance = likelihood.covariance({{state.theta, 1.0}}, state);
  fit.corrected_covariance = fit.covariance;
  fit.lambda = state.lambda();
  fit.inverse_lambda = 1.0 / fit.lambda;
  fit.sigma2 = state.sigma2();
  fit.edf = likelihood.edf(state);
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
  PenalisedFit fit = fit_at(likelihood, found->state);
  if (options.correct_covariance &&
      (likelihood.has_ridge() || likelihood.noise() != NoiseKnowledge::exact)) {
    const auto nodes = reml::posterior_nodes(likelihood, *found);
    fit.corrected_covariance = likelihood.covariance(nodes, found->state);
    fit.inverse_lambda = 0.0;
    for (const auto& node : nodes) fit.inverse_lambda += node.weight * std::exp(-node.theta[0]);
  }
  return fit;
}

tl::expected<PenalisedFit, FitFailure> fit_with_smoothing(const PenalisedProblem& problem,
                                                          double lambda, double sigma2) {
  if (!(lambda > 0.0) || !(sigma2 > 0.0)) {
    throw std::invalid_argument(
        fmt::format("a fit with lambda {} and sigma2 {}; both are positive", lambda, sigma2));
  }
  // At one lambda the ridge is a prior like any other, which spares the eigendecomposition where that
  // is accurate enough.
  const Ridge& ridge = problem.ridge;
  PenalisedProblem with_prior = problem;
  with_prior.ridge = {};
  with_prior.prior_precision.diagonal().segment(ridge.first, ridge.count).array() += lambda;
  for (const PenalisedProblem* one : {&std::as_const(with_prior), &problem}) {
    const reml::Likelihood likelihood(*one, SmoothingPrior::none);
    auto state = likelihood.at({std::log(lambda), std::log(sigma2)});
    if (!state) continue;
    state->value -= static_cast<double>(ridge.count - one->ridge.count) * state->theta[0];
    return fit_at(likelihood, *state);
  }
  return rank_deficient();
}

tl::expected<VectorXd, FitFailure> held_out_residual(const Eigen::Ref<const VectorXd>& residual,
                                                     const Eigen::Ref<const MatrixXd>& spread,
                                                     double sigma2) {
  const Index m = residual.size();
  if (spread.rows() != m || spread.cols() != m) {
    throw std::invalid_argument(fmt::format("{} held-out residuals with a spread of {} x {}", m,
                                            spread.rows(), spread.cols()));
  }
  const linear::Cholesky kept(MatrixXd::Identity(m, m) - spread / sigma2);
  // The rounding of the spread is about 1e-12.
  constexpr double kSmallestPivot = 1e-9;
  if (!kept.is_positive_definite() ||
      kept.lower().diagonal().array().square().minCoeff() < kSmallestPivot) {
    return tl::unexpected(FitFailure{FitFailure::Reason::rank_deficient,
                                     "the other points do not determine the fit without these"});
  }
  return kept.solve(residual);
}

}  // namespace chaintrue::interp
