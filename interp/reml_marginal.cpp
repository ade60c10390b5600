// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_marginal.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace chaintrue::interp::reml {
namespace {

// Eigenvalues below this share of the largest count as zero: the rounding of a penalty's entries is
// about 1e-16 of its largest, its smallest true eigenvalue above 1e-9 for the bases in use.
constexpr double kZeroEigenvalue = 1e-12;

// A pivot of the unit-diagonal A below this means that a combination of columns is free.
constexpr double kZeroPivot = 1e-13;

Eigen::Index rank_of(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = solver.eigenvalues();
  const double largest = values.cwiseAbs().maxCoeff();
  return (values.array() > kZeroEigenvalue * largest).count();
}

// sum_ij a_ij b_ij of two symmetric matrices: the trace of their product.
double trace_of_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.cwiseProduct(b).sum();
}

}  // namespace

Marginal::Marginal(const PenalisedProblem& problem, std::optional<double> fixed_sigma2)
    : problem_(problem) {
  const Eigen::Index q = problem.columns();
  prior_ =
      problem.prior_precision.size() > 0 ? problem.prior_precision : Eigen::MatrixXd::Zero(q, q);
  prior_moment_ = Eigen::VectorXd::Zero(q);
  if (problem.prior_mean.size() > 0) {
    prior_moment_ = prior_ * problem.prior_mean;
    prior_square_ = problem.prior_mean.dot(prior_moment_);
  }
  sigma2_fixed_ = fixed_sigma2.value_or(1.0);
  sigma2_free_ = !fixed_sigma2 && problem.noise.knowledge != NoiseKnowledge::kExact;
  if (problem.noise.knowledge == NoiseKnowledge::kFromRepeats) {
    extra_degrees_ = problem.noise.degrees_of_freedom;
  }
  find_ranks();
}

void Marginal::find_ranks() {
  const Eigen::Index q = problem_.columns();
  std::vector<int> owners(static_cast<std::size_t>(q), 0);
  for (Eigen::Index i = 0; i < q; ++i) {
    owners[static_cast<std::size_t>(i)] += prior_.col(i).isZero(0.0) ? 0 : 1;
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
  const double prior_scale = prior_.cwiseAbs().maxCoeff();
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(q, q);
  if (prior_scale > 0.0) {
    total += prior_ / prior_scale;
    sum_of_ranks += rank_of(prior_);
  }
  for (const Penalty& penalty : problem_.penalties) {
    const Eigen::Index m = penalty.matrix.rows();
    total.block(penalty.first_column, penalty.first_column, m, m) +=
        penalty.matrix / penalty.matrix.cwiseAbs().maxCoeff();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(total);
  const double largest = solver.eigenvalues().maxCoeff();
  const Eigen::Index rank = (solver.eigenvalues().array() > kZeroEigenvalue * largest).count();
  ranges_overlap_ = rank < sum_of_ranks;
  if (!ranges_overlap_) {
    return;
  }
  const Eigen::MatrixXd basis = solver.eigenvectors().rightCols(rank);
  range_prior_ = basis.transpose() * prior_ * basis;
  for (const Penalty& penalty : problem_.penalties) {
    const auto part = basis.middleRows(penalty.first_column, penalty.matrix.rows());
    range_penalty_.push_back(part.transpose() * penalty.matrix * part);
  }
}

double Marginal::sigma2(const Eigen::VectorXd& theta) const {
  return sigma2_free_ ? std::exp(theta(theta.size() - 1)) : sigma2_fixed_;
}

double Marginal::balanced_log_lambda(Eigen::Index k) const {
  const Penalty& penalty = problem_.penalties[static_cast<std::size_t>(k)];
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
  if (order == Order::kValue) {
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
      result.hessian(i, j) -= trace_of_product(solved[static_cast<std::size_t>(i)],
                                               solved[static_cast<std::size_t>(j)].transpose());
    }
  }
  return result;
}

std::optional<State> Marginal::evaluate(const Eigen::VectorXd& theta, Order order) const {
  const Eigen::Index q = problem_.columns();
  const double s2 = sigma2(theta);
  Eigen::MatrixXd a = problem_.gram / s2 + prior_;
  for (Eigen::Index k = 0; k < penalties(); ++k) {
    const Penalty& penalty = problem_.penalties[static_cast<std::size_t>(k)];
    const Eigen::Index m = penalty.matrix.rows();
    a.block(penalty.first_column, penalty.first_column, m, m) +=
        std::exp(theta(k)) * penalty.matrix;
  }
  // Unit diagonal first: what a column is measured in must not decide its rank.
  if (!(a.diagonal().array() > 0.0).all()) {
    return std::nullopt;
  }
  const Eigen::VectorXd scale = a.diagonal().array().rsqrt();
  a = scale.asDiagonal() * a * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(a);
  if (factor.info() != Eigen::Success || factor.matrixLLT().diagonal().array().square().minCoeff() <
                                             kZeroPivot * static_cast<double>(q)) {
    return std::nullopt;
  }
  State state;
  const Eigen::VectorXd moment = problem_.moment / s2 + prior_moment_;
  state.coefficients = scale.cwiseProduct(factor.solve(scale.cwiseProduct(moment)));
  const Eigen::VectorXd& b = state.coefficients;
  state.residual_square = std::max(
      0.0, problem_.response_square - 2.0 * b.dot(problem_.moment) + b.dot(problem_.gram * b));
  // |y - X b|^2 / sigma2 + (b - b0)' S (b - b0) at the minimum over b.
  const double deviance = problem_.response_square / s2 + prior_square_ - b.dot(moment);
  const double log_a =
      2.0 * (factor.matrixLLT().diagonal().array().log().sum() - scale.array().log().sum());
  const double log_s2 = std::log(s2);
  state.value = static_cast<double>(problem_.rows) * log_s2 + deviance + log_a -
                log_determinant(theta, Order::kValue).value + extra_degrees_ * (log_s2 + 1.0 / s2);
  if (order == Order::kHessian) {
    Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(q, q));
    state.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
    add_derivatives(state, theta);
  }
  return state;
}

void Marginal::add_derivatives(State& state, const Eigen::VectorXd& theta) const {
  const Eigen::Index q = problem_.columns();
  const Eigen::Index k = penalties();
  const Eigen::Index unknowns = this->unknowns();
  const double s2 = sigma2(theta);
  const Eigen::MatrixXd& c = state.covariance;
  const Eigen::VectorXd& b = state.coefficients;
  // dA / dtheta_i = D_i, A^-1 D_i = product[i]; force.col(i) = D_i b - d(A b) / dtheta_i.
  std::vector<Eigen::MatrixXd> product;
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(q, unknowns);
  Eigen::VectorXd first(unknowns);
  for (Eigen::Index i = 0; i < k; ++i) {
    const Penalty& penalty = problem_.penalties[static_cast<std::size_t>(i)];
    const Eigen::Index m = penalty.matrix.rows();
    const double lambda = std::exp(theta(i));
    Eigen::MatrixXd p = Eigen::MatrixXd::Zero(q, q);
    p.middleCols(penalty.first_column, m).noalias() =
        lambda * (c.middleCols(penalty.first_column, m) * penalty.matrix);
    product.push_back(std::move(p));
    force.col(i).segment(penalty.first_column, m) =
        lambda * (penalty.matrix * b.segment(penalty.first_column, m));
    first(i) = b.dot(force.col(i));
  }
  if (sigma2_free_) {
    product.push_back(c * problem_.gram / -s2);
    force.col(k) = (problem_.moment - problem_.gram * b) / s2;
    first(k) = -state.residual_square / s2;
  }
  state.coefficient_slopes = -(c * force);
  const LogDeterminant log_s = log_determinant(theta, Order::kHessian);
  state.gradient = first;
  state.hessian = 2.0 * force.transpose() * state.coefficient_slopes;
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    const double trace = product[static_cast<std::size_t>(i)].trace();
    state.gradient(i) += trace;
    // The second derivative of exp(+-theta) adds the first derivative once more, with its sign.
    state.hessian(i, i) += (i < k ? 1.0 : -1.0) * (first(i) + trace);
    for (Eigen::Index j = 0; j < unknowns; ++j) {
      state.hessian(i, j) -= product[static_cast<std::size_t>(i)]
                                 .cwiseProduct(product[static_cast<std::size_t>(j)].transpose())
                                 .sum();
    }
  }
  state.gradient.head(k) -= log_s.gradient;
  state.hessian.topLeftCorner(k, k) -= log_s.hessian;
  if (sigma2_free_) {
    state.gradient(k) += static_cast<double>(problem_.rows) + extra_degrees_ * (1.0 - 1.0 / s2);
    state.hessian(k, k) += extra_degrees_ / s2;
  }
}

}  // namespace chaintrue::interp::reml
