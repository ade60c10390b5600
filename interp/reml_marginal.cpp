// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_marginal.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "interp/symmetric_eigen.hpp"

namespace chaintrue::interp::reml {
namespace {

// Eigenvalues below this share of the largest count as zero: the rounding of a penalty's entries is
// about 1e-16 of its largest, its smallest true eigenvalue above 1e-9 for the bases in use.
constexpr double kZeroEigenvalue = 1e-12;

Eigen::Index rank_of(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd values = symmetric_eigenvalues(matrix);
  const double largest = values.cwiseAbs().maxCoeff();
  return (values.array() > kZeroEigenvalue * largest).count();
}

}  // namespace

Marginal::Marginal(const PenalisedProblem& problem,
                   std::optional<double> fixed_sigma2,
                   SmoothingPrior prior,
                   Shape shape)
    : problem_(problem), prior_kind_(prior) {
  structure_ =
      shape == Shape::any && is_bordered(problem) ? make_bordered(problem) : make_dense(problem);
  if (problem.prior_mean.size() > 0 && problem.prior_precision.size() > 0) {
    prior_square_ = problem.prior_mean.dot(problem.prior_precision * problem.prior_mean);
  }
  sigma2_fixed_ = fixed_sigma2.value_or(1.0);
  sigma2_free_ = !fixed_sigma2 && problem.noise.knowledge != NoiseKnowledge::exact;
  if (problem.noise.knowledge == NoiseKnowledge::from_repeats) {
    extra_degrees_ = problem.noise.degrees_of_freedom;
  }
  find_ranks();
}

void Marginal::find_ranks() {
  const Eigen::Index q = problem_.columns();
  std::vector<int> owners(static_cast<std::size_t>(q), 0);
  const bool prior = problem_.prior_precision.size() > 0;
  for (Eigen::Index i = 0; prior && i < q; ++i) {
    owners[static_cast<std::size_t>(i)] = problem_.prior_precision.col(i).isZero(0.0) ? 0 : 1;
  }
  Eigen::Index sum_of_ranks = 0;
  for (const Penalty& penalty : problem_.penalties) {
    const Eigen::Index rank = penalty.rank >= 0 ? penalty.rank : rank_of(penalty.matrix);
    ranks_.push_back(static_cast<double>(rank));
    sum_of_ranks += rank;
    for (Eigen::Index i = 0; i < penalty.matrix.rows(); ++i) {
      ++owners[static_cast<std::size_t>(penalty.first_column + i)];
    }
  }
  // |S0 + sum lambda_k S_k|_+ is a product of powers of lambda when the ranges only meet in zero;
  // disjoint columns are the cheap proof of that.
  if (std::all_of(owners.begin(), owners.end(), [](int n) { return n <= 1; })) {
    return;
  }
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(q, q);
  if (prior) {
    const double largest = problem_.prior_precision.cwiseAbs().maxCoeff();
    total += problem_.prior_precision / std::max(largest, 1e-300);
    sum_of_ranks +=
        problem_.prior_rank >= 0 ? problem_.prior_rank : rank_of(problem_.prior_precision);
  }
  for (const Penalty& penalty : problem_.penalties) {
    const Eigen::Index m = penalty.matrix.rows();
    total.block(penalty.first_column, penalty.first_column, m, m) +=
        penalty.matrix / penalty.matrix.cwiseAbs().maxCoeff();
  }
  // Ranks that add up to q, and a definite sum: the ranges span the space and cannot overlap.
  if (sum_of_ranks == q) {
    const Eigen::LLT<Eigen::MatrixXd> factor(total);
    if (factor.info() == Eigen::Success &&
        std::pow(factor.matrixLLT().diagonal().minCoeff(), 2) > kZeroEigenvalue) {
      return;
    }
  }
  const SymmetricEigen solver(total);
  const double largest = solver.eigenvalues().maxCoeff();
  const Eigen::Index rank = (solver.eigenvalues().array() > kZeroEigenvalue * largest).count();
  ranges_overlap_ = rank < sum_of_ranks;
  if (!ranges_overlap_) {
    return;
  }
  const Eigen::MatrixXd basis = solver.eigenvectors().rightCols(rank);
  range_prior_ = Eigen::MatrixXd::Zero(rank, rank);
  if (prior) {
    range_prior_ = basis.transpose() * problem_.prior_precision * basis;
  }
  for (const Penalty& penalty : problem_.penalties) {
    const auto part = basis.middleRows(penalty.first_column, penalty.matrix.rows());
    range_penalty_.push_back(part.transpose() * penalty.matrix * part);
  }
}

double Marginal::sigma2(const Eigen::VectorXd& theta) const {
  return sigma2_free_ ? std::exp(theta(theta.size() - 1)) : sigma2_fixed_;
}

double Marginal::flat_slope(Eigen::Index i) const {
  if (i < penalties()) {
    return 1.0;
  }
  return noise_from_repeats() ? 0.0 : -1.0;
}

double Marginal::response_variance() const {
  // Responses below this are rounding errors.
  constexpr double kLeast = 1e-20;
  return std::max(
      problem_.response_square / static_cast<double>(std::max<Eigen::Index>(problem_.rows, 1)),
      kLeast);
}

double Marginal::balanced_log_lambda(Eigen::Index k) const {
  const Penalty& penalty = problem_.penalties[static_cast<std::size_t>(k)];
  if (penalty.balance > 0.0) {
    return std::log(penalty.balance / sigma2_fixed_);
  }
  const Eigen::Index m = penalty.matrix.rows();
  const double data =
      problem_.gram.diagonal().segment(penalty.first_column, m).sum() / sigma2_fixed_;
  return std::log(std::max(data, 1e-300) / penalty.matrix.trace());
}

Marginal::LogDeterminant Marginal::log_determinant(const Eigen::VectorXd& theta,
                                                   Order order) const {
  const Eigen::Index k = penalties();
  LogDeterminant result;
  result.gradient = Eigen::VectorXd::Zero(k);
  result.hessian = Eigen::MatrixXd::Zero(k, k);
  if (!ranges_overlap_) {
    for (Eigen::Index i = 0; i < k; ++i) {
      result.value += ranks_[static_cast<std::size_t>(i)] * theta(i);
      result.gradient(i) = ranks_[static_cast<std::size_t>(i)];
    }
    return result;
  }
  Eigen::MatrixXd total = range_prior_;
  for (Eigen::Index i = 0; i < k; ++i) {
    total += std::exp(theta(i)) * range_penalty_[static_cast<std::size_t>(i)];
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(total);
  result.value = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  if (order == Order::value) {
    return result;
  }
  std::vector<Eigen::MatrixXd> solved;
  for (Eigen::Index i = 0; i < k; ++i) {
    solved.push_back(
        factor.solve(std::exp(theta(i)) * range_penalty_[static_cast<std::size_t>(i)]));
    result.gradient(i) = solved.back().trace();
    result.hessian(i, i) = result.gradient(i);
  }
  for (Eigen::Index i = 0; i < k; ++i) {
    for (Eigen::Index j = 0; j < k; ++j) {
      result.hessian(i, j) -= solved[static_cast<std::size_t>(i)]
                                  .cwiseProduct(solved[static_cast<std::size_t>(j)].transpose())
                                  .sum();
    }
  }
  return result;
}

std::optional<State> Marginal::evaluate(const Eigen::VectorXd& theta, Order order) const {
  const double s2 = sigma2(theta);
  const auto factor = structure_->factor(theta.head(penalties()).array().exp(), s2);
  if (!factor) {
    return std::nullopt;
  }
  State state;
  BestFit best = best_fit(*factor, s2);
  state.coefficients = std::move(best.coefficients);
  state.deviance = best.deviance;
  const double log_s2 = std::log(s2);
  state.value = static_cast<double>(problem_.rows) * log_s2 + state.deviance +
                factor->log_determinant() - log_determinant(theta, Order::value).value +
                extra_degrees_ * (log_s2 + 1.0 / s2);
  if (order == Order::hessian) {
    add_derivatives(state, *factor, theta);
  }
  for (Eigen::Index i = 0; prior_kind_ == SmoothingPrior::avoids_boundary && i < unknowns(); ++i) {
    state.value += flat_slope(i) * theta(i);
    if (order == Order::hessian) {
      state.gradient(i) += flat_slope(i);
    }
  }
  return state;
}

Eigen::VectorXd Marginal::add_inverse(const Eigen::VectorXd& theta,
                                      double weight,
                                      WorkingCovariance& sum) const {
  const double s2 = sigma2(theta);
  const auto factor = structure_->factor(theta.head(penalties()).array().exp(), s2);
  factor->add_inverse(weight, sum);
  return best_fit(*factor, s2).coefficients;
}

BestFit Marginal::best_fit(const Factor& factor, double s2) const {
  if (auto best = factor.best()) {
    return *std::move(best);
  }
  const Eigen::VectorXd moment = structure_->moment() / s2 + structure_->prior_moment();
  BestFit fit{factor.solve(moment), 0.0};
  fit.deviance = problem_.response_square / s2 + prior_square_ - fit.coefficients.dot(moment);
  return fit;
}

// With D_i = dA / dtheta_i and u_i = D_i b - d(A b) / dtheta_i, db / dtheta_i = -A^-1 u_i. For
// sigma2 D = -(A - S), which spares X'X: A^-1 D = -(1 - sum A^-1 D_k - A^-1 S0).
void Marginal::add_derivatives(State& state,
                               const Factor& factor,
                               const Eigen::VectorXd& theta) const {
  const Eigen::Index q = problem_.columns();
  const Eigen::Index k = penalties();
  const Eigen::Index n = unknowns();
  const Eigen::VectorXd& b = state.coefficients;
  const double s2 = sigma2(theta);
  const Traces traces = factor.traces();
  Eigen::MatrixXd u(q, n);
  Eigen::VectorXd trace(n);
  Eigen::VectorXd first(n);
  Eigen::MatrixXd second(n, n);
  for (Eigen::Index i = 0; i < k; ++i) {
    u.col(i) = std::exp(theta(i)) * structure_->penalty_times(i, b);
    first(i) = b.dot(u.col(i));
  }
  trace.head(k) = traces.first.head(k);
  second.topLeftCorner(k, k) = traces.second.topLeftCorner(k, k);
  if (sigma2_free_) {
    const Eigen::VectorXd prior_force =
        structure_->penalty_times(k, b) - structure_->prior_moment();
    u.col(k) = u.leftCols(k).rowwise().sum() + prior_force;
    const double penalty_square = first.head(k).sum() + b.dot(prior_force) -
                                  b.dot(structure_->prior_moment()) + prior_square_;
    first(k) = -(state.deviance - penalty_square);
    trace(k) = -(static_cast<double>(q) - traces.first.sum());
    second(k, k) = static_cast<double>(q) - 2.0 * traces.first.sum() + traces.second.sum();
    second.col(k).head(k) = -(traces.first.head(k) - traces.second.topRows(k).rowwise().sum());
    second.row(k).head(k) = second.col(k).head(k).transpose();
  }
  state.gradient = first + trace;
  state.hessian = -2.0 * u.transpose() * factor.solve(u) - second;
  for (Eigen::Index i = 0; i < n; ++i) {
    // The second derivative of exp(+-theta) adds the first derivative once more, with its sign.
    state.hessian(i, i) += (i < k ? 1.0 : -1.0) * state.gradient(i);
  }
  const LogDeterminant log_s = log_determinant(theta, Order::hessian);
  state.gradient.head(k) -= log_s.gradient;
  state.hessian.topLeftCorner(k, k) -= log_s.hessian;
  if (sigma2_free_) {
    state.gradient(k) += static_cast<double>(problem_.rows) + extra_degrees_ * (1.0 - 1.0 / s2);
    state.hessian(k, k) += extra_degrees_ / s2;
  }
}

}  // namespace chaintrue::interp::reml
