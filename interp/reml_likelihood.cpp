// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp::reml {
namespace {

void check(const PenalisedProblem& problem) {
  const Eigen::Index q = problem.columns();
  const Ridge& ridge = problem.ridge;
  const auto fail = [](const std::string& what) { throw std::invalid_argument(what); };
  if (problem.keeps_rows && problem.design.rows() != problem.rows) {
    fail(fmt::format("{} of {} rows were kept", problem.design.rows(), problem.rows));
  }
  if (q == 0 || problem.gram.rows() != q || problem.moment.size() != q ||
      problem.prior_precision.rows() != q || problem.prior_precision.cols() != q ||
      problem.prior_mean.size() != q) {
    fail(
        fmt::format("a fit with X'X of {} x {}, X'y of {}, a prior precision of {} x {} and a "
                    "prior mean of {}",
                    problem.gram.rows(),
                    q,
                    problem.moment.size(),
                    problem.prior_precision.rows(),
                    problem.prior_precision.cols(),
                    problem.prior_mean.size()));
  }
  if (!problem.gram.allFinite() || !problem.moment.allFinite() ||
      !std::isfinite(problem.response_square)) {
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

}  // namespace

ScaledCholesky::ScaledCholesky(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& diagonal) {
  // A pivot of the unit-diagonal matrix below this value means that a combination of columns is
  // undetermined.
  constexpr double kZeroPivot = 1e-12;
  if (!(diagonal.array() > 0.0).all()) return;
  scale_ = diagonal.array().rsqrt();
  factor_ = linear::Cholesky(scale_.asDiagonal() * matrix * scale_.asDiagonal());
  positive_ = factor_.is_positive_definite() && (factor_.lower().diagonal().array().square() >=
                                                 kZeroPivot * static_cast<double>(matrix.rows()))
                                                    .all();
}

double ScaledCholesky::log_determinant() const {
  return factor_.log_det() - 2.0 * scale_.array().log().sum();
}

Eigen::MatrixXd ScaledCholesky::solve(const Eigen::MatrixXd& right) const {
  return scale_.asDiagonal() * factor_.solve(Eigen::MatrixXd(scale_.asDiagonal() * right));
}

Eigen::MatrixXd ScaledCholesky::inverse_root() const {
  return scale_.asDiagonal() * factor_.root_of_inverse();
}

Likelihood::Likelihood(const PenalisedProblem& problem, SmoothingPrior prior)
    : problem_(problem), prior_kind_(prior) {
  check(problem);
  finds_sigma2_ = problem.noise.knowledge != NoiseKnowledge::exact;
  if (problem.noise.knowledge == NoiseKnowledge::from_repeats) {
    extra_degrees_ = problem.noise.degrees_of_freedom;
  }
  gather(problem.ridge);
  if (problem.ridge.count > 0) diagonalise();
}

Likelihood::Likelihood(const PenalisedProblem& problem, const Theta& fixed)
    : problem_(problem), prior_kind_(SmoothingPrior::none) {
  check(problem);
  if (problem.noise.knowledge == NoiseKnowledge::from_repeats) {
    extra_degrees_ = problem.noise.degrees_of_freedom;
  }
  gather({});
  shared_prior_.diagonal().segment(problem.ridge.first, problem.ridge.count).array() +=
      std::exp(fixed[0]);
}

void Likelihood::gather(const Ridge& ridge) {
  first_ = ridge.first;
  for (Eigen::Index i = 0; i < problem_.columns(); ++i) {
    if (i < ridge.first || i >= ridge.first + ridge.count) shared_.push_back(i);
  }
  shared_gram_ = problem_.gram(shared_, shared_);
  shared_prior_ = problem_.prior_precision(shared_, shared_);
  shared_mean_ = problem_.prior_mean(shared_);
  coupling_ = Eigen::MatrixXd::Zero(0, shared_gram_.cols());
  moment_ = problem_.moment(shared_);
}

void Likelihood::diagonalise() {
  const Eigen::Index m = problem_.ridge.count;
  const auto in_ridge = Eigen::seqN(first_, m);
  if (problem_.keeps_rows && problem_.rows <= m) {
    const Eigen::MatrixXd f = problem_.design.middleCols(first_, m);
    const linear::SymmetricEigen solver(linear::outer(f));
    const Eigen::MatrixXd q = solver.eigenvectors().rowwise().reverse();
    const Eigen::VectorXd g = solver.eigenvalues().reverse().cwiseMax(0.0);
    // The columns of F'Q are orthogonal, of squares g. Householder's Q of them is R. It is
    // orthonormal to rounding even where g is at rounding level, and it spans the directions that
    // no row reaches.
    const Eigen::MatrixXd turned = linear::product(linear::transposed(f), q);
    basis_ = linear::qr(turned).q;
    eigenvalues_ = Eigen::VectorXd::Zero(m);
    eigenvalues_.head(g.size()) = g;
    rows_ = TurnedRows{g,
                       linear::product(linear::transposed(q), problem_.design(Eigen::all, shared_)),
                       linear::product(linear::transposed(q), problem_.response),
                       linear::product(linear::transposed(basis_), turned)};
  } else {
    const linear::SymmetricEigen solver(problem_.gram(in_ridge, in_ridge));
    basis_ = solver.eigenvectors();
    eigenvalues_ = solver.eigenvalues().cwiseMax(0.0);
  }
  coupling_ = linear::product(linear::transposed(basis_), problem_.gram(in_ridge, shared_));
  Eigen::VectorXd moment(problem_.columns());
  moment << basis_.transpose() * problem_.moment.segment(first_, m), moment_;
  moment_ = std::move(moment);
}

double Likelihood::balance() const {
  return problem_.ridge.balance > 0.0
             ? problem_.ridge.balance
             : eigenvalues_.sum() / static_cast<double>(eigenvalues_.size());
}

double Likelihood::response_variance() const {
  // Responses below this are rounding errors.
  constexpr double kLeast = 1e-20;
  return std::max(
      problem_.response_square / static_cast<double>(std::max<Eigen::Index>(problem_.rows, 1)),
      kLeast);
}

Theta Likelihood::flat_slope() const {
  return {has_ridge() ? 1.0 : 0.0, finds_sigma2_ && !noise_from_repeats() ? -1.0 : 0.0};
}

std::optional<Likelihood::Factor> Likelihood::factor(const Theta& theta) const {
  const double lambda = std::exp(theta[0]);
  const double per_sigma2 = std::exp(-theta[1]);
  const Eigen::VectorXd a = eigenvalues_.array() * per_sigma2 + lambda;
  const Eigen::VectorXd inverse = a.cwiseInverse();
  Eigen::MatrixXd u = (per_sigma2 * inverse).asDiagonal() * coupling_;
  Eigen::MatrixXd h = per_sigma2 * shared_gram_ + shared_prior_;
  Eigen::VectorXd diagonal = h.diagonal();
  Eigen::VectorXd of_rows;
  if (rows_) {
    of_rows = (std::exp(theta[1]) + rows_->eigenvalues.array() / lambda).inverse();
    h = shared_prior_;
    linear::add_product(
        h, 1.0, linear::transposed(rows_->shared), of_rows.asDiagonal() * rows_->shared);
    diagonal = h.diagonal();
  } else {
    linear::add_product(h, -per_sigma2, linear::transposed(coupling_), u);
  }
  ScaledCholesky corner(h, diagonal);
  if (!corner.positive()) return std::nullopt;
  const double log_determinant = a.array().log().sum() + corner.log_determinant();
  return Factor{lambda,
                std::exp(theta[1]),
                inverse,
                std::move(u),
                std::move(of_rows),
                std::move(corner),
                log_determinant};
}

Likelihood::BestFit Likelihood::solve(const Factor& factor) const {
  const Eigen::Index m = eigenvalues_.size();
  const Eigen::VectorXd pull = shared_prior_ * shared_mean_;
  Eigen::VectorXd b(problem_.columns());
  if (rows_) {  // (6)
    const Eigen::VectorXd s = factor.corner.solve(
        pull + rows_->shared.transpose() * (factor.of_rows.asDiagonal() * rows_->response));
    const Eigen::VectorXd residual = rows_->response - rows_->shared * s;
    const Eigen::VectorXd weighted = factor.of_rows.asDiagonal() * residual;
    b << rows_->to_ridge * (weighted / factor.lambda), s;
    return {b, residual.dot(weighted) + (s - shared_mean_).dot(shared_prior_ * (s - shared_mean_))};
  }
  Eigen::VectorXd right = moment_ / factor.sigma2;
  right.tail(pull.size()) += pull;
  const Eigen::VectorXd s =
      factor.corner.solve(right.tail(pull.size()) - factor.u.transpose() * right.head(m));
  b << factor.inverse.asDiagonal() * right.head(m) - factor.u * s, s;
  return {b, problem_.response_square / factor.sigma2 + shared_mean_.dot(pull) - b.dot(right)};
}

std::optional<State> Likelihood::evaluate(const Theta& theta, Order order) const {
  const auto a = factor(theta);
  if (!a) return std::nullopt;
  const BestFit best = solve(*a);
  State state;
  state.coefficients = best.coefficients;
  state.value = static_cast<double>(problem_.rows) * theta[1] + best.deviance + a->log_determinant -
                static_cast<double>(eigenvalues_.size()) * theta[0] +
                extra_degrees_ * (theta[1] + 1.0 / a->sigma2);
  if (order == Order::hessian) add_derivatives(state, *a, best.deviance);
  if (prior_kind_ == SmoothingPrior::avoids_boundary) {
    state.value += flat_slope().dot(theta);
    if (order == Order::hessian) state.gradient += flat_slope();
  }
  return state;
}

// With D_i = dA / dtheta_i and u_i = D_i b - d(A b) / dtheta_i, db / dtheta_i = -A^-1 u_i. For
// sigma2 D = -(A - S), which spares X'X: A^-1 D = -(1 - A^-1 lambda J - A^-1 S0).
void Likelihood::add_derivatives(State& state, const Factor& factor, double deviance) const {
  const Eigen::Index m = eigenvalues_.size();
  const auto p = static_cast<Eigen::Index>(shared_.size());
  const auto q = static_cast<double>(problem_.columns());
  const Eigen::VectorXd v = state.coefficients.head(m);
  const Eigen::VectorXd off = state.coefficients.tail(p) - shared_mean_;

  // Traces of A^-1 D and of A^-1 D A^-1 D', for D and D' of lambda J (0) and S0 (1).
  const Eigen::MatrixXd root = factor.corner.inverse_root();
  const Eigen::MatrixXd corner = linear::outer(root);
  const Eigen::VectorXd plain = factor.lambda * factor.inverse;
  const Eigen::VectorXd extra =
      factor.lambda * linear::product(factor.u, corner).cwiseProduct(factor.u).rowwise().sum();
  const Eigen::MatrixXd of_ridge = factor.lambda * linear::product(corner, linear::gram(factor.u));
  const Eigen::MatrixXd of_prior = linear::product(corner, shared_prior_);
  const auto trace_of_product = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.cwiseProduct(b.transpose()).sum();
  };
  const double t0 = plain.sum() + extra.sum();
  const double t1 = of_prior.trace();
  const double t00 =
      plain.squaredNorm() + 2.0 * plain.dot(extra) + trace_of_product(of_ridge, of_ridge);
  const double t01 = trace_of_product(of_ridge, of_prior);
  const double t11 = trace_of_product(of_prior, of_prior);

  const double ridge_square = factor.lambda * v.squaredNorm();
  const Eigen::VectorXd force = shared_prior_ * off;
  const Theta trace(t0, -(q - t0 - t1));
  const Theta first(ridge_square, -(deviance - ridge_square - off.dot(force)));
  Eigen::Matrix2d second;
  second << t00, -(t0 - t00 - t01), -(t0 - t00 - t01), q - 2.0 * (t0 + t1) + t00 + 2.0 * t01 + t11;

  // u = (lambda v, 0) and (lambda v, force); u' A^-1 u by the root of the corner.
  const Eigen::VectorXd of_v = factor.lambda * (factor.u.transpose() * v);
  Eigen::MatrixXd halves(p, 2);
  halves << -root.transpose() * of_v, root.transpose() * (force - of_v);
  const double in_ridge = factor.lambda * v.dot(plain.cwiseProduct(v));
  const Eigen::Matrix2d square = linear::gram(halves) + Eigen::Matrix2d::Constant(in_ridge);

  // The second derivative of exp(+-theta) adds the signed first derivative again.
  const Theta twice(first + trace);
  state.hessian = -2.0 * square - second;
  state.hessian(0, 0) += twice[0];
  state.hessian(1, 1) += -twice[1] + extra_degrees_ / factor.sigma2;
  state.gradient = twice + Theta(-static_cast<double>(m),
                                 static_cast<double>(problem_.rows) +
                                     extra_degrees_ * (1.0 - 1.0 / factor.sigma2));
}

Eigen::MatrixXd Likelihood::covariance(const std::vector<Node>& nodes, const State& centre) const {
  const Eigen::Index m = eigenvalues_.size();
  const auto p = static_cast<Eigen::Index>(shared_.size());
  const auto count = static_cast<Eigen::Index>(nodes.size());
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(m);
  // (-U', I)' H^-1 (-U', I) = W W' with W = (-U', I)' times a root of H^-1; one wide product is
  // faster than many narrow ones.
  Eigen::MatrixXd wide(problem_.columns(), count * (p + 1));
  for (Eigen::Index k = 0; k < count; ++k) {
    const Node& node = nodes[static_cast<std::size_t>(k)];
    const Factor a = factor(node.theta).value();
    const Eigen::MatrixXd root = std::sqrt(node.weight) * a.corner.inverse_root();
    diagonal += node.weight * a.inverse;
    wide.block(0, k * p, m, p) = -linear::product(a.u, root);
    wide.block(m, k * p, p, p) = root;
    wide.col(count * p + k) =
        std::sqrt(node.weight) * (solve(a).coefficients - centre.coefficients);
  }
  Eigen::MatrixXd working = linear::outer(wide);
  working.diagonal().head(m) += diagonal;
  Eigen::MatrixXd result = to_columns(to_columns(working).transpose());
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  return result;
}

Eigen::MatrixXd Likelihood::to_columns(const Eigen::MatrixXd& working) const {
  const Eigen::Index m = eigenvalues_.size();
  Eigen::MatrixXd result(working.rows(), working.cols());
  result.middleRows(first_, m) = linear::product(basis_, working.topRows(m));
  result(shared_, Eigen::all) = working.bottomRows(working.rows() - m);
  return result;
}

}  // namespace chaintrue::interp::reml
