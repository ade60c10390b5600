// SPDX-License-Identifier: GPL-3.0-or-later
// Notation as in reml.hpp; theta are the logarithms of lambda_k, then of sigma2 where it is free.
#include "interp/reml.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "interp/reml_average.hpp"
#include "interp/reml_marginal.hpp"
#include "interp/reml_search.hpp"

namespace chaintrue::interp {
namespace {

tl::unexpected<FitFailure> rank_deficient() {
  return tl::unexpected(FitFailure{
      FitFailure::Reason::rank_deficient,
      "the points do not determine the fit: some combination of its unknowns is left free"});
}

// What follows from the coefficients and their covariance.
void fill_residuals(const PenalisedProblem& problem, PenalisedFit& fit) {
  const Eigen::VectorXd& b = fit.coefficients;
  fit.residual_square = problem.keeps_rows
                            ? (problem.response - problem.design * b).squaredNorm()
                            : std::max(0.0,
                                       problem.response_square - 2.0 * b.dot(problem.moment) +
                                           b.dot(problem.gram * b));
  fit.column_edf = fit.covariance.cwiseProduct(problem.gram).rowwise().sum() / fit.sigma2;
  fit.edf = fit.column_edf.sum();
}

PenalisedFit assemble(const PenalisedProblem& problem,
                      const reml::Marginal& marginal,
                      const reml::SearchResult& found,
                      const FitOptions& options) {
  const reml::State state = marginal.evaluate(found.theta, reml::Order::hessian).value();
  const reml::Structure& structure = marginal.structure();
  const Eigen::Index k = marginal.penalties();
  PenalisedFit fit;
  fit.coefficients = structure.to_columns(state.coefficients);
  reml::WorkingCovariance inverse;
  marginal.add_inverse(found.theta, 1.0, inverse);
  fit.covariance = structure.covariance_to_columns(inverse, Eigen::MatrixXd(problem.columns(), 0));
  fit.lambda = found.theta.head(k).array().exp();
  fit.sigma2 = marginal.sigma2(found.theta);
  fill_residuals(problem, fit);
  fit.minus_two_log_reml = state.value;
  fit.iterations = found.iterations;
  fit.ends = found.ends;
  const Eigen::MatrixXd spread = reml::covariance_from_hessian(state.hessian, found.ends);
  Eigen::VectorXd sigma = spread.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < k; ++i) {
    if (found.ends[static_cast<std::size_t>(i)] != SmoothingEnd::inside) {
      sigma(i) = std::numeric_limits<double>::infinity();
    }
  }
  fit.log_lambda_sigma = sigma.head(k);
  fit.inverse_lambda = fit.lambda.cwiseInverse();
  fit.corrected_covariance = fit.covariance;
  if (options.correct_covariance && marginal.unknowns() > 0) {
    reml::Averaged averaged = reml::averaged_covariance(marginal, found, sigma);
    fit.corrected_covariance = std::move(averaged.covariance);
    fit.inverse_lambda = std::move(averaged.inverse_lambda);
  }
  return fit;
}

}  // namespace

tl::expected<PenalisedFit, FitFailure> fit_penalised(const PenalisedProblem& problem,
                                                     const FitOptions& options) {
  reml::check(problem);
  const reml::Marginal marginal(problem, std::nullopt, options.prior);
  if (!marginal.positive()) {
    return rank_deficient();
  }
  const auto found = reml::search(marginal, options.maximum_iterations);
  if (!found) {
    return found.error() == FitFailure::Reason::rank_deficient
               ? rank_deficient()
               : tl::unexpected(
                     FitFailure{found.error(),
                                fmt::format("the choice of smoothing did not settle in {} steps",
                                            options.maximum_iterations)});
  }
  return assemble(problem, marginal, *found, options);
}

tl::expected<PenalisedFit, FitFailure> fit_with_smoothing(
    const PenalisedProblem& problem,
    const Eigen::Ref<const Eigen::VectorXd>& lambda,
    double sigma2) {
  reml::check(problem);
  if (lambda.size() != static_cast<Eigen::Index>(problem.penalties.size()) ||
      !(lambda.array() > 0.0).all() || !(sigma2 > 0.0)) {
    throw std::invalid_argument(
        "each penalty needs a positive lambda, and sigma2 must be positive");
  }
  // For one lambda the dense form costs less than the preparation for many lambdas, if it is
  // accurate enough.
  const Eigen::VectorXd theta = lambda.array().log();
  std::optional<reml::Marginal> marginal;
  std::optional<reml::State> state;
  for (const reml::Shape shape : {reml::Shape::dense, reml::Shape::any}) {
    marginal.emplace(problem, sigma2, SmoothingPrior::none, shape);
    state = marginal->positive() ? marginal->evaluate(theta, reml::Order::value) : std::nullopt;
    if (state) {
      break;
    }
  }
  if (!state) {
    return rank_deficient();
  }
  const reml::Structure& structure = marginal->structure();
  PenalisedFit fit;
  fit.coefficients = structure.to_columns(state->coefficients);
  reml::WorkingCovariance inverse;
  marginal->add_inverse(theta, 1.0, inverse);
  fit.covariance = structure.covariance_to_columns(inverse, Eigen::MatrixXd(problem.columns(), 0));
  fit.corrected_covariance = fit.covariance;
  fit.lambda = lambda;
  fit.inverse_lambda = lambda.cwiseInverse();
  fit.log_lambda_sigma = Eigen::VectorXd::Zero(lambda.size());
  fit.ends.assign(problem.penalties.size(), SmoothingEnd::inside);
  fit.sigma2 = sigma2;
  fill_residuals(problem, fit);
  fit.minus_two_log_reml = state->value;
  return fit;
}

tl::expected<double, FitFailure> minus_two_log_reml(const PenalisedProblem& problem,
                                                    const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                                    double sigma2) {
  reml::check(problem);
  const reml::Marginal marginal(problem, sigma2);
  if (marginal.positive()) {
    if (const auto state = marginal.evaluate(lambda.array().log(), reml::Order::value)) {
      return state->value;
    }
  }
  return rank_deficient();
}

namespace {

// The Cholesky factor of I - H_gg.
tl::expected<Eigen::LLT<Eigen::MatrixXd>, FitFailure> without_group(
    const Eigen::Ref<const Eigen::MatrixXd>& spread, double sigma2) {
  const Eigen::Index m = spread.rows();
  Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(m, m) - spread / sigma2);
  // The rounding of covariance * gram is about 1e-12.
  constexpr double kSmallestPivot = 1e-9;
  if (factor.info() != Eigen::Success ||
      factor.matrixLLT().diagonal().array().square().minCoeff() < kSmallestPivot) {
    return tl::unexpected(FitFailure{FitFailure::Reason::rank_deficient,
                                     "the other points do not determine the fit without these"});
  }
  return factor;
}

}  // namespace

tl::expected<HeldOut, FitFailure> PenalisedFit::held_out(
    const Eigen::Ref<const Eigen::MatrixXd>& design,
    const Eigen::Ref<const Eigen::VectorXd>& response) const {
  if (design.cols() != coefficients.size() || design.rows() != response.size()) {
    throw std::invalid_argument(fmt::format("{} x {} held-out rows and {} responses for {} columns",
                                            design.rows(),
                                            design.cols(),
                                            response.size(),
                                            coefficients.size()));
  }
  const auto factor = without_group(design * covariance * design.transpose(), sigma2);
  if (!factor) {
    return tl::unexpected(factor.error());
  }
  HeldOut result;
  result.residual = factor->solve(response - design * coefficients);
  result.covariance =
      sigma2 * factor->solve(Eigen::MatrixXd::Identity(design.rows(), design.rows()));
  return result;
}

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
  return without_group(spread, sigma2).map([&](const Eigen::LLT<Eigen::MatrixXd>& factor) {
    return Eigen::VectorXd(factor.solve(residual));
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
    return held_out_residual(residual, root * root.transpose(), sigma2);
  }
  // (I - W W' / s2)^-1 = I + W (s2 I - W' W)^-1 W'; one is positive definite if and only if the
  // other is.
  Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(root.cols(), root.cols());
  inner.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose());
  inner.triangularView<Eigen::StrictlyUpper>() = inner.transpose();
  return without_group(inner, sigma2).map([&](const Eigen::LLT<Eigen::MatrixXd>& factor) {
    return Eigen::VectorXd(residual + root * factor.solve(root.transpose() * residual) / sigma2);
  });
}

}  // namespace chaintrue::interp
