// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/linear_algebra.hpp"

#include <Eigen/Dense>
#include <cstdlib>
#include <string_view>

#include "interp/linear_algebra_kernels.hpp"
#include "interp/require.hpp"

namespace chaintrue::linear {

const kernels::Table* kernels::avx2_here() {
#ifdef CHAINTRUE_HAS_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return &avx2;
#endif
  return nullptr;
}

const kernels::Table& kernels::chosen() {
  static const Table* const best = [] {
    const char* const asked = std::getenv("CHAINTRUE_BASELINE");
    const bool is_baseline = asked != nullptr && std::string_view(asked) == "1";
    return is_baseline || avx2_here() == nullptr ? &baseline : avx2_here();
  }();
  return *best;
}

namespace {

kernels::Input input(const Operand& a) {
  const auto& stored = a.stored;
  return {stored.data(), stored.rows(), stored.cols(), stored.outerStride(), a.is_transposed};
}
kernels::Output output(Eigen::Ref<MatrixXd> c) {
  return {c.data(), c.rows(), c.cols(), c.outerStride()};
}

}  // namespace

void add_product(Eigen::Ref<MatrixXd> c, double scale, const Operand& a, const Operand& b) {
  require(c.rows() == a.rows() && c.cols() == b.columns() && a.columns() == b.rows() &&
              !(a.is_transposed && b.is_transposed),
          "a product {} x {} of {} x {} and {} x {}", c.rows(), c.cols(), a.rows(), a.columns(),
          b.rows(), b.columns());
  if (c.size() > 0 && a.columns() > 0) {
    kernels::chosen().add_product(output(c), scale, input(a), input(b));
  }
}

void add_outer(MatrixXd& c, double scale, const Operand& a) {
  require(c.rows() == a.rows() && c.cols() == a.rows(), "{} x {} and a square of {} x {}", c.rows(),
          c.cols(), a.rows(), a.rows());
  if (c.size() == 0 || a.columns() == 0) return;
  kernels::chosen().add_square(output(c), scale, input(a));
  for (Index k = 1; k < c.cols(); ++k) c.col(k).head(k) = c.row(k).head(k).transpose();
}

MatrixXd outer(const Operand& a, double diagonal) {
  MatrixXd c = MatrixXd::Zero(a.rows(), a.rows());
  c.diagonal().setConstant(diagonal);
  add_outer(c, 1.0, a);
  return c;
}

MatrixXd scaled_columns(const Eigen::Ref<const MatrixXd>& a, const Eigen::Ref<const VectorXd>& s) {
  return a * s.asDiagonal();
}

void solve_triangle(const Operand& lower, Eigen::Ref<MatrixXd> x) {
  require(lower.rows() == x.rows(), "{} equations of {} unknowns", x.rows(), lower.rows());
  if (x.size() > 0) kernels::chosen().solve_triangle(input(lower), output(x));
}

Cholesky::Cholesky(MatrixXd matrix) : lower_(std::move(matrix)) {
  require(lower_.rows() == lower_.cols(), "a symmetric matrix of {} x {}", lower_.rows(),
          lower_.cols());
  if (lower_.size() == 0) return;
  is_positive_definite_ = kernels::chosen().factorise(output(lower_)) &&
                          lower_.diagonal().allFinite() && (lower_.diagonal().array() > 0.0).all();
  lower_.triangularView<Eigen::StrictlyUpper>().setZero();
}

MatrixXd Cholesky::inverse() const { return solve(MatrixXd::Identity(size(), size())); }
MatrixXd Cholesky::root_of_inverse() const {
  MatrixXd x = MatrixXd::Identity(size(), size());
  solve_triangle(transposed(lower_), x);
  return x;
}
double Cholesky::log_det() const { return 2.0 * lower_.diagonal().array().log().sum(); }

PivotedCholesky::PivotedCholesky(const MatrixXd& matrix)
    : factor_(std::make_shared<const Eigen::LDLT<MatrixXd>>(matrix)) {}

MatrixXd PivotedCholesky::solved(const MatrixXd& b) const { return factor_->solve(b); }
MatrixXd PivotedCholesky::inverse() const {
  return solved(MatrixXd::Identity(factor_->rows(), factor_->rows()));
}

MatrixXd PivotedCholesky::root(double least) const {
  const VectorXd pivots = factor_->vectorD();
  const VectorXd scale = (pivots.array() > least).select(pivots.cwiseSqrt(), 0.0);
  const MatrixXd lower = factor_->matrixL();
  return factor_->transpositionsP().transpose() * scaled_columns(lower, scale);
}

SymmetricEigen::SymmetricEigen(const MatrixXd& matrix) {
  if (matrix.rows() == 0) return;  // the solver would take a vector of -1 entries
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  values_ = solver.eigenvalues();
  vectors_ = solver.eigenvectors();
}

MatrixXd covariance_root(const MatrixXd& covariance) {
  const SymmetricEigen parts(covariance);
  const VectorXd scale = parts.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return scaled_columns(parts.eigenvectors(), scale);
}

Tridiagonal::Tridiagonal(MatrixXd matrix)
    : reflections_(std::move(matrix)), diagonal_(reflections_.rows()) {
  const Index n = reflections_.rows();
  if (n == 0) return;
  coefficients_.resize(n - 1);
  subdiagonal_.resize(n - 1);
  kernels::chosen().tridiagonalise(output(reflections_), coefficients_.data(), diagonal_.data(),
                                   subdiagonal_.data());
}

void Tridiagonal::rotate_in_place(MatrixXd& x) const {
  require(x.rows() == reflections_.rows(), "{} rows to rotate, of {}", x.rows(),
          reflections_.rows());
  if (x.size() == 0) return;
  kernels::chosen().rotate(input(reflections_), coefficients_.data(), output(x));
}

namespace {

using Householder = Eigen::HouseholderQR<MatrixXd>;

MatrixXd triangle_of(const Householder& factor) {
  return factor.matrixQR().topRows(factor.cols()).triangularView<Eigen::Upper>();
}

}  // namespace

Qr qr(const MatrixXd& a) {
  const Householder factor(a);
  return {factor.householderQ(), triangle_of(factor)};
}

MatrixXd orthonormal_columns(const MatrixXd& a) {
  return Householder(a).householderQ() * MatrixXd::Identity(a.rows(), a.cols());
}

MatrixXd upper_triangle(const MatrixXd& a) { return triangle_of(Householder(a)); }

Range range_of(const MatrixXd& a, double least) {
  Eigen::ColPivHouseholderQR<MatrixXd> factor(a);
  if (least > 0.0) factor.setThreshold(least);
  const MatrixXd q = factor.householderQ();
  return {q.leftCols(factor.rank()), q.rightCols(a.rows() - factor.rank())};
}

MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) {
  return Eigen::CompleteOrthogonalDecomposition<MatrixXd>(a).solve(b);
}

ThinSvd thin_svd(const MatrixXd& a) {
  if (a.size() == 0) return {MatrixXd(a.rows(), 0), VectorXd(0)};
  const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinU);
  return {svd.matrixU(), svd.singularValues()};
}

MatrixXd inverse(const MatrixXd& a) { return a.inverse(); }

}  // namespace chaintrue::linear
