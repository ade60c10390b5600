// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace chaintrue::interp::reml {
namespace {

void check(const PenalisedProblem& problem) {
  const Index q = problem.columns();
  const Ridge& ridge = problem.ridge;
  const auto fail = [](const std::string& what) { throw std::invalid_argument(what); };
  if (!problem.design.allFinite() || !problem.response.allFinite()) {
    fail("the data of a penalised fit are not finite");
  }
  if (ridge.first < 0 || ridge.count < 0 || ridge.first + ridge.count > q) {
    fail(fmt::format("a ridge of {} columns from {} on among {}", ridge.count, ridge.first, q));
  }
  if (!problem.prior_precision.middleCols(ridge.first, ridge.count).isZero(0.0) ||
      !problem.prior_mean.segment(ridge.first, ridge.count).isZero(0.0)) {
    fail("prior knowledge of a ridge's columns besides the ridge");
  }
  if (problem.noise.knowledge == NoiseKnowledge::from_repeats &&
      !(problem.noise.degrees_of_freedom > 0.0)) {
    fail(fmt::format("a noise scale known from {} degrees of freedom",
                     problem.noise.degrees_of_freedom));
  }
}

struct InverseRoot {
  MatrixXd root;  // W with W W' the inverse
  double log_determinant;
};

// The matrix is scaled to unit diagonal, because the units of a column must not affect its rank.
// Empty where it is not positive definite to rounding.
std::optional<InverseRoot> inverse_root(const MatrixXd& matrix) {
  // A pivot of the unit-diagonal matrix below this value means that a combination of columns is
  // undetermined.
  constexpr double kZeroPivot = 1e-12;
  if (!(matrix.diagonal().array() > 0.0).all()) return std::nullopt;
  const VectorXd scale = matrix.diagonal().array().rsqrt();
  const linear::Cholesky factor(scale.asDiagonal() * matrix * scale.asDiagonal());
  const bool is_positive =
      factor.is_positive_definite() && (factor.lower().diagonal().array().square() >=
                                        kZeroPivot * static_cast<double>(matrix.rows()))
                                           .all();
  if (!is_positive) return std::nullopt;
  return InverseRoot{scale.asDiagonal() * factor.root_of_inverse(),
                     factor.log_det() - 2.0 * scale.array().log().sum()};
}

}  // namespace

double State::lambda() const { return std::exp(theta[0]); }
double State::sigma2() const { return std::exp(theta[1]); }

Likelihood::Likelihood(const PenalisedProblem& problem, SmoothingPrior prior) : problem_(problem) {
  check(problem);
  if (noise() == NoiseKnowledge::from_repeats) degrees_ = problem.noise.degrees_of_freedom;
  if (prior == SmoothingPrior::avoids_boundary) prior_slope_ = flat_slope();
  const Ridge& ridge = problem.ridge;
  for (Index i = 0; i < problem.columns(); ++i) {
    if (i < ridge.first || i >= ridge.first + ridge.count) shared_.push_back(i);
  }
  shared_prior_ = problem.prior_precision(shared_, shared_);
  shared_mean_ = problem.prior_mean(shared_);
  rows_ = problem.design(Eigen::all, shared_);
  response_ = problem.response;
  eigenvalues_ = VectorXd::Zero(response_.size());
  to_ridge_ = MatrixXd::Zero(0, response_.size());
  if (has_ridge()) turn_rows();
}

void Likelihood::turn_rows() {
  const Index m = problem_.ridge.count;
  const Index p = rows_.cols();
  MatrixXd all(response_.size(), m + p + 1);
  all << problem_.design.middleCols(problem_.ridge.first, m), rows_, response_;
  if (all.rows() > all.cols()) all = linear::upper_triangle(all);
  const MatrixXd f = all.leftCols(m);
  const linear::SymmetricEigen solver(linear::outer(f));
  const MatrixXd q = solver.eigenvectors().rowwise().reverse();
  eigenvalues_ = solver.eigenvalues().reverse().cwiseMax(0.0);
  const Index rank = std::min(m, all.rows());
  eigenvalues_.tail(all.rows() - rank).setZero();
  // The columns of F'Q are orthogonal, of squares g. Householder's Q of them is R. It is orthonormal
  // to rounding even where g is at rounding level, and it spans the directions that no row reaches.
  to_ridge_ = linear::product(linear::transposed(f), q);
  to_ridge_.rightCols(all.rows() - rank).setZero();
  basis_ = linear::qr(to_ridge_.leftCols(rank)).q;
  const MatrixXd rest = linear::product(linear::transposed(q), all.rightCols(p + 1));
  rows_ = rest.leftCols(p);
  response_ = rest.col(p);
}

double Likelihood::balance() const {
  return problem_.ridge.balance > 0.0
             ? problem_.ridge.balance
             : eigenvalues_.sum() / static_cast<double>(problem_.ridge.count);
}

double Likelihood::response_variance() const {
  // Responses below this are rounding errors.
  constexpr double kLeast = 1e-20;
  return std::max(response_.squaredNorm() / static_cast<double>(std::max<Index>(problem_.rows, 1)),
                  kLeast);
}

Theta Likelihood::flat_slope() const {
  return {has_ridge() ? 1.0 : 0.0, noise() == NoiseKnowledge::unknown ? -1.0 : 0.0};
}

std::optional<State> Likelihood::at(const Theta& theta) const {
  State state;
  state.theta = theta;
  state.weights = (state.sigma2() + eigenvalues_.array() / state.lambda()).inverse();
  MatrixXd h = shared_prior_;
  linear::add_gram(h, 1.0, state.weights.cwiseSqrt().asDiagonal() * rows_);
  auto inverse = inverse_root(h);
  if (!inverse) return std::nullopt;
  state.root = std::move(inverse->root);
  const VectorXd right =
      shared_prior_ * shared_mean_ + rows_.transpose() * (state.weights.asDiagonal() * response_);
  state.shared = state.root * (state.root.transpose() * right);
  state.residual = response_ - rows_ * state.shared;
  const VectorXd off = state.shared - shared_mean_;
  const auto more_rows = static_cast<double>(problem_.rows - response_.size());
  state.value = more_rows * theta[1] - state.weights.array().log().sum() +
                inverse->log_determinant +
                state.residual.dot(state.weights.asDiagonal() * state.residual) +
                off.dot(shared_prior_ * off) + degrees_ * (theta[1] + 1.0 / state.sigma2()) +
                prior_slope_.dot(theta);
  return state;
}

Derivatives Likelihood::derivatives(const State& state) const {
  const VectorXd& d = state.weights;
  const MatrixXd halves = linear::product(rows_, state.root);  // K is their square
  const VectorXd fits = d.cwiseProduct(state.residual.cwiseAbs2() + halves.rowwise().squaredNorm());
  Eigen::MatrixX2d e(d.size(), 2);
  e << d.cwiseProduct(eigenvalues_ / -state.lambda()), state.sigma2() * d;
  const Theta slope = e.transpose() * (1.0 - fits.array()).matrix();
  Derivatives result{slope, e.transpose() * (2.0 * fits.array() - 1.0).matrix().asDiagonal() * e};
  // The second derivatives of w are the first with their sign.
  result.hessian.diagonal() += Theta(-slope[0], slope[1]);
  Eigen::MatrixX2d pull(halves.cols(), 2);
  Eigen::MatrixX2d spread(halves.cols() * halves.cols(), 2);
  for (Index i = 0; i < 2; ++i) {
    const MatrixXd weighted = d.cwiseProduct(e.col(i)).asDiagonal() * halves;
    pull.col(i) = weighted.transpose() * state.residual;
    spread.col(i) = linear::product(linear::transposed(halves), weighted).reshaped();
  }
  result.hessian -= 2.0 * pull.transpose() * pull + spread.transpose() * spread;
  result.gradient += prior_slope_;
  result.gradient[1] += static_cast<double>(problem_.rows - response_.size()) +
                        degrees_ * (1.0 - 1.0 / state.sigma2());
  result.hessian(1, 1) += degrees_ / state.sigma2();
  return result;
}

double Likelihood::edf(const State& state) const {
  const VectorXd leverage = linear::product(rows_, state.root).rowwise().squaredNorm();
  return state.weights.dot(eigenvalues_ / state.lambda() +
                           state.sigma2() * state.weights.cwiseProduct(leverage));
}

VectorXd Likelihood::coefficients(const State& state) const {
  VectorXd b(problem_.columns());
  b.segment(problem_.ridge.first, problem_.ridge.count) =
      to_ridge_ * (state.weights.asDiagonal() * state.residual) / state.lambda();
  b(shared_) = state.shared;
  return b;
}

MatrixXd Likelihood::covariance(const std::vector<Node>& nodes, const State& centre) const {
  const auto [first, m, balance] = problem_.ridge;
  const Index p = rows_.cols();
  const auto count = static_cast<Index>(nodes.size());
  const VectorXd middle = coefficients(centre);
  VectorXd g = VectorXd::Zero(m);
  const Index rank = std::min(m, eigenvalues_.size());
  g.head(rank) = eigenvalues_.head(rank);
  VectorXd of_ridge = VectorXd::Zero(m);
  // (-U', I)' H^-1 (-U', I) = W W' with W = (-U', I)' times a root of H^-1; one wide product is
  // faster than many narrow ones.
  MatrixXd wide(problem_.columns(), count * (p + 1));
  for (Index k = 0; k < count; ++k) {
    const Node& node = nodes[static_cast<std::size_t>(k)];
    const State state = at(node.theta).value();
    const double root = std::sqrt(node.weight);
    of_ridge.array() += node.weight / (g.array() / state.sigma2() + state.lambda());
    const MatrixXd weighted = (-root / state.lambda() * state.weights).asDiagonal() * rows_;
    wide.block(first, k * p, m, p) =
        linear::product(linear::product(to_ridge_, weighted), state.root);
    wide(shared_, Eigen::seqN(k * p, p)) = root * state.root;
    wide.col(count * p + k) = root * (coefficients(state) - middle);
  }
  MatrixXd result = linear::outer(wide);
  result.block(first, first, m, m) +=
      linear::outer(linear::scaled_columns(basis_, of_ridge.cwiseSqrt()));
  return result;
}

}  // namespace chaintrue::interp::reml
