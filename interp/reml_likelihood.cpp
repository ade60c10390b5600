// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "interp/linear_algebra.hpp"
#include "interp/require.hpp"

namespace chaintrue::interp::reml {
namespace {

const PenalisedProblem& checked(const PenalisedProblem& problem) {
  const Index q = problem.columns();
  const Index m = problem.ridge.count;
  require(problem.design.allFinite() && problem.response.allFinite(),
          "the data of a penalised fit are not finite");
  require(m >= 0 && m <= q, "a ridge of {} columns among {}", m, q);
  require(
      problem.prior_precision.rightCols(m).isZero(0.0) && problem.prior_mean.tail(m).isZero(0.0),
      "prior knowledge of a ridge's columns besides the ridge");
  const auto& [knowledge, degrees] = problem.noise;
  require(knowledge != NoiseKnowledge::from_repeats || degrees > 0.0,
          "a noise scale known from {} degrees of freedom", degrees);
  return problem;
}

// W with W W' the inverse. The matrix is scaled to unit diagonal, because the units of a column must
// not affect its rank. Empty where it is not positive definite to rounding.
std::optional<MatrixXd> inverse_root(const MatrixXd& matrix) {
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
  return scale.asDiagonal() * factor.root_of_inverse();
}

}  // namespace

Likelihood::Likelihood(const PenalisedProblem& problem, SmoothingPrior prior)
    : problem_(checked(problem)),
      eigenvalues_(VectorXd::Zero(problem.response.size())),
      rows_(problem.design.leftCols(problem.columns() - problem.ridge.count)),
      response_(problem.response),
      to_ridge_(MatrixXd::Zero(0, response_.size())) {
  if (has_ridge()) turn_rows();
  const auto [knowledge, degrees] = problem.noise;
  if (knowledge == NoiseKnowledge::from_repeats) degrees_ = degrees;
  slope_[1] = static_cast<double>(problem.rows - response_.size()) + degrees_;
  Theta& with_flat = prior == SmoothingPrior::avoids_boundary ? slope_ : left_out_slope_;
  if (has_ridge()) with_flat[0] += 1.0;
  if (knowledge == NoiseKnowledge::unknown) with_flat[1] -= 1.0;
}

void Likelihood::turn_rows() {
  const Index m = problem_.ridge.count;
  const Index p = rows_.cols();
  MatrixXd all(response_.size(), p + m + 1);
  all << problem_.design, response_;
  if (all.rows() > all.cols()) all = linear::upper_triangle(all);
  const MatrixXd f = all.middleCols(p, m);
  const linear::SymmetricEigen solver(linear::outer(f));
  const MatrixXd q = solver.eigenvectors().rowwise().reverse();
  eigenvalues_ = solver.eigenvalues().reverse().cwiseMax(0.0);
  const Index rank = std::min(m, all.rows());
  eigenvalues_.tail(all.rows() - rank).setZero();
  // The columns of F'Q are orthogonal, of squares g. Householder's Q of them is R. It is orthonormal
  // to rounding even where g is at rounding level, and it spans the directions that no row reaches.
  to_ridge_ = linear::inner(f, q);
  to_ridge_.rightCols(all.rows() - rank).setZero();
  basis_ = linear::qr(to_ridge_.leftCols(rank)).q;
  rows_ = linear::inner(q, all.leftCols(p));
  response_ = linear::inner(q, all.col(p + m));
}

std::optional<State> Likelihood::at(const Theta& theta) const {
  const Index p = rows_.cols();
  const auto prior = problem_.prior_precision.topLeftCorner(p, p);
  const auto mean = problem_.prior_mean.head(p);
  State state;
  state.theta = theta;
  state.weights = (state.sigma2() + eigenvalues_.array() / state.lambda()).inverse();
  MatrixXd h = prior;
  linear::add_gram(h, 1.0, state.weights.cwiseSqrt().asDiagonal() * rows_);
  const auto root = inverse_root(h);
  if (!root) return std::nullopt;
  state.root = *root;
  const VectorXd right = prior * mean + rows_.transpose() * state.weights.cwiseProduct(response_);
  state.shared = state.root * (state.root.transpose() * right);
  state.residual = response_ - rows_ * state.shared;
  const VectorXd off = state.shared - mean;
  state.value = slope_.dot(theta) + degrees_ / state.sigma2() - state.weights.array().log().sum() -
                2.0 * state.root.diagonal().array().log().sum() +
                state.weights.dot(state.residual.cwiseAbs2()) + off.dot(prior * off);
  return state;
}

Derivatives Likelihood::derivatives(const State& state) const {
  const VectorXd& d = state.weights;
  const MatrixXd halves = linear::product(rows_, state.root);  // K is their square
  const VectorXd fits = d.cwiseProduct(state.residual.cwiseAbs2() + halves.rowwise().squaredNorm());
  Eigen::MatrixX2d e(d.size(), 2);
  e << d.cwiseProduct(eigenvalues_ / -state.lambda()), state.sigma2() * d;
  const Theta slope = e.transpose() * (1.0 - fits.array()).matrix();
  Derivatives result{slope + slope_,
                     e.transpose() * (2.0 * fits.array() - 1.0).matrix().asDiagonal() * e};
  // The second derivatives of w are the first with their sign.
  result.hessian.diagonal() += Theta(-slope[0], slope[1]);
  const Eigen::MatrixX2d weighted = d.asDiagonal() * e;
  const Eigen::MatrixX2d pull = halves.transpose() * (state.residual.asDiagonal() * weighted);
  Eigen::MatrixX2d spread(halves.cols() * halves.cols(), 2);
  for (Index i = 0; i < 2; ++i)
    spread.col(i) = linear::inner(halves, weighted.col(i).asDiagonal() * halves).reshaped();
  result.hessian -= 2.0 * pull.transpose() * pull + spread.transpose() * spread;
  result.gradient[1] -= degrees_ / state.sigma2();
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
  b << state.shared, to_ridge_ * state.weights.cwiseProduct(state.residual) / state.lambda();
  return b;
}

MatrixXd Likelihood::covariance(const std::vector<Node>& nodes, const State& centre) const {
  const Index m = problem_.ridge.count;
  const Index p = rows_.cols();
  const VectorXd middle = coefficients(centre);
  VectorXd g = eigenvalues_;
  g.conservativeResizeLike(VectorXd::Zero(m));
  VectorXd of_ridge = VectorXd::Zero(m);
  // Each term of (6) and of the deviations is a square: one wide product of their roots is faster than
  // many narrow ones. (I, -U')' H^-1 (I, -U') is that of (I, -U')' W.
  MatrixXd roots(p + m, std::ssize(nodes) * (p + 1) + m);
  Index column = 0;
  for (const auto& [state, weight] : nodes) {
    const double root = std::sqrt(weight);
    const MatrixXd half = root * state.root;
    of_ridge.array() += weight / (g.array() / state.sigma2() + state.lambda());
    const MatrixXd fits = (state.weights / -state.lambda()).asDiagonal() * rows_;
    roots.middleCols(column, p) << half, linear::product(linear::product(to_ridge_, fits), half);
    roots.col(column + p) = root * (coefficients(state) - middle);
    column += p + 1;
  }
  roots.rightCols(m) << MatrixXd::Zero(p, m), basis_ * of_ridge.cwiseSqrt().asDiagonal();
  return linear::outer(roots);
}

}  // namespace chaintrue::interp::reml
