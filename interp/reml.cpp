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

#include "interp/reml_marginal.hpp"
#include "interp/reml_search.hpp"

namespace chaintrue::interp {
namespace {

void check(const PenalisedProblem& problem) {
  const Eigen::Index q = problem.columns();
  const auto fail = [](const std::string& what) { throw std::invalid_argument(what); };
  if (problem.keeps_rows && problem.design.rows() != problem.rows) {
    fail(fmt::format("{} of {} rows were kept", problem.design.rows(), problem.rows));
  }
  if (q == 0 || problem.gram.rows() != q || problem.moment.size() != q) {
    fail(fmt::format(
        "a fit with X'X of {} x {} and X'y of {}", problem.gram.rows(), q, problem.moment.size()));
  }
  if (!problem.gram.allFinite() || !problem.moment.allFinite() ||
      !std::isfinite(problem.response_square)) {
    fail("the data of a penalised fit are not finite");
  }
  if (problem.prior_precision.size() != 0 &&
      (problem.prior_precision.rows() != q || problem.prior_precision.cols() != q)) {
    fail(fmt::format("a prior precision of {} x {} for {} columns",
                     problem.prior_precision.rows(),
                     problem.prior_precision.cols(),
                     q));
  }
  if (problem.prior_mean.size() != 0 && problem.prior_mean.size() != q) {
    fail(fmt::format("a prior mean of {} for {} columns", problem.prior_mean.size(), q));
  }
  for (const Penalty& penalty : problem.penalties) {
    const Eigen::Index m = penalty.matrix.rows();
    if (m == 0 || penalty.matrix.cols() != m || penalty.first_column < 0 ||
        penalty.first_column + m > q || !penalty.matrix.allFinite()) {
      fail(fmt::format("a penalty of {} x {} from column {} on among {} columns",
                       m,
                       penalty.matrix.cols(),
                       penalty.first_column,
                       q));
    }
  }
  if (problem.noise.knowledge == NoiseKnowledge::kFromRepeats &&
      !(problem.noise.degrees_of_freedom > 0.0)) {
    fail(fmt::format("a noise scale known from {} degrees of freedom",
                     problem.noise.degrees_of_freedom));
  }
}

tl::unexpected<FitRefusal> rank_deficient() {
  return tl::unexpected(FitRefusal{
      FitFailure::kRankDeficient,
      "the points do not determine the fit: some combination of its unknowns is left free"});
}

// A point of the posterior of theta and its weight.
struct ThetaNode {
  Eigen::VectorXd theta;
  double weight;
};

// Walks one or two components of theta outward from the optimum while the posterior is worth e^-4
// of its peak.
class PosteriorGrid {
 public:
  PosteriorGrid(const reml::Marginal& marginal,
                const reml::SearchResult& found,
                Eigen::VectorXd sigma)
      : marginal_(marginal), found_(found), centre_(found.theta), sigma_(std::move(sigma)) {}

  std::vector<ThetaNode> over(Eigen::Index i) {
    peak_ = -std::numeric_limits<double>::infinity();
    nodes_.clear();
    walk(i, centre_);
    return normalized();
  }

  // `i` is walked anew, from its best so far, at each value of `outer`.
  std::vector<ThetaNode> over(Eigen::Index i, Eigen::Index outer) {
    peak_ = -std::numeric_limits<double>::infinity();
    nodes_.clear();
    const double step = step_of(outer);
    for (const double direction : {-1.0, 1.0}) {
      Eigen::VectorXd from = centre_;
      for (int j = direction < 0.0 ? 0 : 1; j < kLongest; ++j) {
        from(outer) = centre_(outer) + direction * step * j;
        if (from(outer) < found_.low(outer) || from(outer) > found_.high(outer)) {
          break;
        }
        const Best best = walk(i, from);
        if (!(best.log_weight > peak_ - kNegligible)) {
          break;
        }
        from(i) = best.at;
      }
    }
    return normalized();
  }

 private:
  static constexpr double kNegligible = 4.0;
  static constexpr int kLongest = 60;
  struct Best {
    double at;
    double log_weight;
  };

  // The averaging always has the prior, so that it is proper; the fit has it where it was asked
  // for.
  [[nodiscard]] double missing_prior(const Eigen::VectorXd& theta) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; marginal_.prior() == SmoothingPrior::kNone && i < theta.size(); ++i) {
      sum += marginal_.flat_slope(i) * theta(i);
    }
    return sum;
  }

  [[nodiscard]] double step_of(Eigen::Index i) const { return std::clamp(sigma_(i), 0.2, 1.0); }

  Best walk(Eigen::Index i, const Eigen::VectorXd& from) {
    const double step = step_of(i);
    Best best{from(i), -std::numeric_limits<double>::infinity()};
    for (const double direction : {-1.0, 1.0}) {
      for (int j = direction < 0.0 ? 0 : 1; j < kLongest; ++j) {
        Eigen::VectorXd theta = from;
        theta(i) += direction * step * j;
        if (theta(i) < found_.low(i) || theta(i) > found_.high(i)) {
          break;
        }
        const auto state = marginal_.evaluate(theta, reml::Order::kValue);
        if (!state) {
          break;
        }
        const double w = -0.5 * (state->value + missing_prior(theta));
        if (w > best.log_weight) {
          best = {theta(i), w};
        }
        peak_ = std::max(peak_, w);
        if (w < best.log_weight - kNegligible) {
          break;
        }
        nodes_.push_back({std::move(theta), w});
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<ThetaNode> normalized() const {
    std::vector<ThetaNode> kept;
    double sum = 0.0;
    for (const ThetaNode& node : nodes_) {
      if (node.weight > peak_ - kNegligible) {
        kept.push_back({node.theta, std::exp(node.weight - peak_)});
        sum += kept.back().weight;
      }
    }
    for (ThetaNode& node : kept) {
      node.weight /= sum;
    }
    return kept;
  }

  const reml::Marginal& marginal_;
  const reml::SearchResult& found_;
  Eigen::VectorXd centre_;
  Eigen::VectorXd sigma_;
  double peak_ = 0.0;
  std::vector<ThetaNode> nodes_;
};

struct Averaged {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd inverse_lambda;
};

// The posterior covariance of b about the fit with theta averaged over rather than fixed: E[A^-1] +
// E[(b - fit)(b - fit)']. What each lambda adds to A^-1 is added up; where sigma2 is free each
// lambda is averaged together with it.
Averaged averaged_covariance(const reml::Marginal& marginal,
                             const reml::SearchResult& found,
                             const Eigen::VectorXd& sigma) {
  reml::WorkingCovariance sum;
  const Eigen::Index k = marginal.penalties();
  Eigen::VectorXd inverse_lambda = Eigen::VectorXd::Zero(k);
  const Eigen::VectorXd fit = marginal.add_inverse(
      found.theta, 1.0 - static_cast<double>(marginal.sigma2_free() && k == 0 ? 1 : k), sum);
  std::vector<Eigen::VectorXd> shifts;
  const auto add = [&](const std::vector<ThetaNode>& nodes) {
    for (const ThetaNode& node : nodes) {
      const Eigen::VectorXd b = marginal.add_inverse(node.theta, node.weight, sum);
      shifts.emplace_back(std::sqrt(node.weight) * (b - fit));
    }
  };
  PosteriorGrid grid(marginal, found, sigma);
  for (Eigen::Index i = 0; i < k; ++i) {
    const std::vector<ThetaNode> nodes = marginal.sigma2_free() ? grid.over(i, k) : grid.over(i);
    add(nodes);
    for (const ThetaNode& node : nodes) {
      inverse_lambda(i) += node.weight * std::exp(-node.theta(i));
    }
  }
  if (marginal.sigma2_free() && k == 0) {
    add(grid.over(k));
  }
  Eigen::MatrixXd shift_columns(fit.size(), static_cast<Eigen::Index>(shifts.size()));
  for (std::size_t j = 0; j < shifts.size(); ++j) {
    shift_columns.col(static_cast<Eigen::Index>(j)) = shifts[j];
  }
  // Weights below zero on the plain part may leave a rounding below zero where nothing was added.
  sum.diagonal = sum.diagonal.cwiseMax(0.0);
  return {marginal.structure().covariance_to_columns(sum, shift_columns),
          std::move(inverse_lambda)};
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
  const reml::State state = marginal.evaluate(found.theta, reml::Order::kHessian).value();
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
    if (found.ends[static_cast<std::size_t>(i)] != SmoothingEnd::kInside) {
      sigma(i) = std::numeric_limits<double>::infinity();
    }
  }
  fit.log_lambda_sigma = sigma.head(k);
  fit.inverse_lambda = fit.lambda.cwiseInverse();
  fit.corrected_covariance = fit.covariance;
  if (options.correct_covariance && marginal.unknowns() > 0) {
    Averaged averaged = averaged_covariance(marginal, found, sigma);
    fit.corrected_covariance = std::move(averaged.covariance);
    fit.inverse_lambda = std::move(averaged.inverse_lambda);
  }
  return fit;
}

}  // namespace

PenalisedProblem::PenalisedProblem(Eigen::Index columns)
    : gram(Eigen::MatrixXd::Zero(columns, columns)), moment(Eigen::VectorXd::Zero(columns)) {}

void PenalisedProblem::add_rows(const Eigen::Ref<const Eigen::MatrixXd>& x,
                                const Eigen::Ref<const Eigen::VectorXd>& y) {
  if (x.cols() != columns() || x.rows() != y.size()) {
    throw std::invalid_argument(fmt::format("{} x {} design rows and {} responses for {} columns",
                                            x.rows(),
                                            x.cols(),
                                            y.size(),
                                            columns()));
  }
  gram.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
  gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
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

void PenalisedProblem::add_sparse_row(const std::vector<Eigen::Index>& indices,
                                      const std::vector<double>& values,
                                      double y) {
  if (keeps_rows || indices.size() != values.size()) {
    throw std::invalid_argument(keeps_rows ? "a problem that keeps its rows takes whole ones"
                                           : fmt::format("a sparse row of {} columns and {} values",
                                                         indices.size(),
                                                         values.size()));
  }
  for (std::size_t a = 0; a < indices.size(); ++a) {
    if (indices[a] < 0 || indices[a] >= columns()) {
      throw std::invalid_argument(fmt::format("column {} of {}", indices[a], columns()));
    }
    double* column = gram.col(indices[a]).data();
    for (std::size_t b = 0; b < indices.size(); ++b) {
      column[indices[b]] += values[a] * values[b];
    }
    moment(indices[a]) += values[a] * y;
  }
  response_square += y * y;
  ++rows;
}

tl::expected<PenalisedFit, FitRefusal> fit_penalised(const PenalisedProblem& problem,
                                                     const FitOptions& options) {
  check(problem);
  const reml::Marginal marginal(problem, std::nullopt, options.prior);
  if (!marginal.positive()) {
    return rank_deficient();
  }
  const auto found = reml::search(marginal, options.maximum_iterations);
  if (!found) {
    return found.error() == FitFailure::kRankDeficient
               ? rank_deficient()
               : tl::unexpected(
                     FitRefusal{found.error(),
                                fmt::format("the choice of smoothing did not settle in {} steps",
                                            options.maximum_iterations)});
  }
  return assemble(problem, marginal, *found, options);
}

tl::expected<PenalisedFit, FitRefusal> fit_with_smoothing(
    const PenalisedProblem& problem,
    const Eigen::Ref<const Eigen::VectorXd>& lambda,
    double sigma2) {
  check(problem);
  if (lambda.size() != static_cast<Eigen::Index>(problem.penalties.size()) ||
      !(lambda.array() > 0.0).all() || !(sigma2 > 0.0)) {
    throw std::invalid_argument(
        "each penalty needs a positive lambda, and sigma2 must be positive");
  }
  // One lambda: A as it is costs less than what makes many of them cheap, where it has the digits.
  const Eigen::VectorXd theta = lambda.array().log();
  std::optional<reml::Marginal> marginal;
  std::optional<reml::State> state;
  for (const reml::Shape shape : {reml::Shape::kDense, reml::Shape::kAny}) {
    marginal.emplace(problem, sigma2, SmoothingPrior::kNone, shape);
    state = marginal->positive() ? marginal->evaluate(theta, reml::Order::kValue) : std::nullopt;
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
  fit.ends.assign(problem.penalties.size(), SmoothingEnd::kInside);
  fit.sigma2 = sigma2;
  fill_residuals(problem, fit);
  fit.minus_two_log_reml = state->value;
  return fit;
}

tl::expected<double, FitRefusal> minus_two_log_reml(const PenalisedProblem& problem,
                                                    const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                                    double sigma2) {
  check(problem);
  const reml::Marginal marginal(problem, sigma2);
  if (marginal.positive()) {
    if (const auto state = marginal.evaluate(lambda.array().log(), reml::Order::kValue)) {
      return state->value;
    }
  }
  return rank_deficient();
}

namespace {

// The Cholesky factor of I - H_gg.
tl::expected<Eigen::LLT<Eigen::MatrixXd>, FitRefusal> without_group(
    const Eigen::Ref<const Eigen::MatrixXd>& spread, double sigma2) {
  const Eigen::Index m = spread.rows();
  Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(m, m) - spread / sigma2);
  // The rounding of covariance * gram leaves about 1e-12 of one.
  constexpr double kSmallestPivot = 1e-9;
  if (factor.info() != Eigen::Success ||
      factor.matrixLLT().diagonal().array().square().minCoeff() < kSmallestPivot) {
    return tl::unexpected(FitRefusal{FitFailure::kRankDeficient,
                                     "the other points do not determine the fit without these"});
  }
  return factor;
}

}  // namespace

tl::expected<HeldOut, FitRefusal> PenalisedFit::held_out(
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

tl::expected<Eigen::VectorXd, FitRefusal> held_out_residual(
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

tl::expected<Eigen::VectorXd, FitRefusal> held_out_residual_by_root(
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
  // (I - W W' / s2)^-1 = I + W (s2 I - W' W)^-1 W', and both are positive where one is.
  Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(root.cols(), root.cols());
  inner.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose());
  inner.triangularView<Eigen::StrictlyUpper>() = inner.transpose();
  return without_group(inner, sigma2).map([&](const Eigen::LLT<Eigen::MatrixXd>& factor) {
    return Eigen::VectorXd(residual + root * factor.solve(root.transpose() * residual) / sigma2);
  });
}

}  // namespace chaintrue::interp
