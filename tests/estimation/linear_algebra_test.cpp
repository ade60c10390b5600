// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/linear_algebra.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "grid/random.hpp"
#include "interp/linear_algebra_kernels.hpp"

namespace chaintrue::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint64_t kSeed = 47;
// Sums of up to 300 products of numbers near one round by some 1e-14, and a solution by that times
// its matrix's condition, below a thousand here.
constexpr double kRounding = 1e-10;
// Few enough for plain loops, one block of the kernels, and several with a remainder.
constexpr Index kSizes[] = {0, 1, 2, 3, 7, 31, 150};

/// Matrices of one seed.
class Draws {
 public:
  MatrixXd matrix(Index rows, Index columns) {
    MatrixXd matrix(rows, columns);
    for (double& value : matrix.reshaped()) value = random_.normal();
    return matrix;
  }

  MatrixXd definite(Index n) {
    const MatrixXd root = matrix(n, n);
    return MatrixXd::Identity(n, n) +
           root * root.transpose() / std::max<double>(1.0, static_cast<double>(n));
  }

 private:
  grid::Random random_{kSeed};
};

class LinearAlgebra : public testing::Test, public Draws {
 private:
  const testing::ScopedTrace trace_{__FILE__, __LINE__, kSeed};
};

double largest(const MatrixXd& matrix) {
  return matrix.size() == 0 ? 0.0 : matrix.cwiseAbs().maxCoeff();
}

void expect_near(const MatrixXd& a, const MatrixXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  EXPECT_LT(largest(a - b), kRounding);
}

MatrixXd identity(Index n) { return MatrixXd::Identity(n, n); }

/// The sum that a product is.
MatrixXd plain_product(const MatrixXd& a, const MatrixXd& b) {
  MatrixXd c = MatrixXd::Zero(a.rows(), b.cols());
  for (Index i = 0; i < c.rows(); ++i) {
    for (Index j = 0; j < c.cols(); ++j) {
      for (Index k = 0; k < a.cols(); ++k) c(i, j) += a(i, k) * b(k, j);
    }
  }
  return c;
}

MatrixXd square_of(const MatrixXd& root) { return plain_product(root, root.transpose()); }

TEST_F(LinearAlgebra, ProductIsTheSumOfProducts) {
  for (const Index n : kSizes) {
    for (const Index m : {Index{0}, Index{1}, Index{5}, Index{40}}) {
      SCOPED_TRACE(testing::Message() << n << " x " << m);
      const MatrixXd a = matrix(n, m);
      const MatrixXd b = matrix(m, 9);
      const VectorXd x = matrix(m, 1);
      const MatrixXd c = plain_product(a, b);
      expect_near(product(a, b), c);
      const MatrixXd at = a.transpose();
      const MatrixXd bt = b.transpose();
      expect_near(product(transposed(at), b), c);
      expect_near(product(a, transposed(bt)), c);
      expect_near(product(a, x), plain_product(a, x));
      expect_near(product(transposed(at), x), plain_product(a, x));
      expect_near(gram(a), plain_product(at, a));
      expect_near(outer(a), plain_product(a, at));
      expect_near(one_plus_gram(a), identity(m) + plain_product(at, a));
      expect_near(outer(a, 1.0), identity(n) + plain_product(a, at));
      expect_near(carried(a, outer(b)), square_of(c));
    }
  }
}

TEST_F(LinearAlgebra, ProductAddsToABlockFromBlocks) {
  const MatrixXd a = matrix(20, 30);
  const MatrixXd b = matrix(40, 12);
  const MatrixXd before = matrix(16, 14);
  MatrixXd c = before;
  add_product(c.block(2, 3, 10, 8), -0.5, a.middleRows(4, 10), b.block(5, 1, 30, 8));
  MatrixXd wanted = before;
  wanted.block(2, 3, 10, 8) -= 0.5 * plain_product(a.middleRows(4, 10), b.block(5, 1, 30, 8));
  expect_near(c, wanted);
  VectorXd y = before.col(0);
  add_product(y.head(10), 2.0, transposed(b.topLeftCorner(20, 10)), a.col(7));
  VectorXd wanted_y = before.col(0);
  wanted_y.head(10) += 2.0 * plain_product(b.topLeftCorner(20, 10).transpose(), a.col(7));
  expect_near(y, wanted_y);
  MatrixXd symmetric = outer(before);
  add_outer(symmetric, 0.3, a.topRows(16));
  add_outer(symmetric, -0.1, VectorXd(a.col(0).head(16)));
  expect_near(symmetric, square_of(before) + 0.3 * square_of(a.topRows(16)) -
                             0.1 * square_of(a.col(0).head(16)));
}

TEST_F(LinearAlgebra, ProductRefusesSizesThatDoNotFit) {
  MatrixXd a = MatrixXd::Zero(2, 3);
  const VectorXd x = VectorXd::Zero(2);
  EXPECT_THROW(static_cast<void>(product(a, a)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(product(a, x)), std::invalid_argument);
  EXPECT_THROW(add_outer(a, 1.0, x), std::invalid_argument);
  EXPECT_THROW(Cholesky{a}, std::invalid_argument);
  EXPECT_THROW(static_cast<void>(Cholesky(identity(3)).solve(x)), std::invalid_argument);
}

TEST_F(LinearAlgebra, CholeskyFactorsSolvesAndInverts) {
  for (const Index n : kSizes) {
    SCOPED_TRACE(n);
    const MatrixXd m = definite(n);
    const Cholesky factor(m);
    ASSERT_TRUE(factor.is_positive_definite());
    const MatrixXd& l = factor.lower();
    expect_near(square_of(l), m);
    EXPECT_EQ(largest(l.triangularView<Eigen::StrictlyUpper>().toDenseMatrix()), 0.0);
    const MatrixXd b = matrix(n, 4);
    const VectorXd x = matrix(n, 1);
    expect_near(plain_product(m, factor.solve(b)), b);
    expect_near(plain_product(m, factor.solve(x)), x);
    expect_near(plain_product(l, factor.half_solve(b)), b);
    expect_near(plain_product(l, factor.half_solve(x)), x);
    MatrixXd in_place(n, 6);
    in_place.leftCols(4) = b;
    in_place.rightCols(2).setOnes();
    factor.half_solve_in_place(in_place.leftCols(4));
    expect_near(in_place.leftCols(4), factor.half_solve(b));
    EXPECT_EQ(largest(in_place.rightCols(2) - MatrixXd::Ones(n, 2)), 0.0);
    expect_near(plain_product(m, factor.inverse()), identity(n));
    const MatrixXd root = factor.root_of_inverse();
    expect_near(square_of(root), factor.inverse());
    EXPECT_NEAR(factor.log_det(), SymmetricEigen(m).eigenvalues().array().log().sum(), kRounding);
  }
}

TEST_F(LinearAlgebra, CholeskyRefusesIndefiniteMatrices) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Index n : {Index{1}, Index{3}, Index{100}}) {
    for (const double pivot : {0.0, -1.0, kNan}) {
      MatrixXd m = identity(n);
      m(n - 1, n - 1) = pivot;
      EXPECT_FALSE(Cholesky(m).is_positive_definite()) << n << ", " << pivot;
    }
  }
  EXPECT_TRUE(Cholesky().is_positive_definite());
}

TEST_F(LinearAlgebra, PivotedCholeskySolvesSemidefiniteSystems) {
  for (const Index n : {Index{0}, Index{1}, Index{5}, Index{20}}) {
    SCOPED_TRACE(n);
    const MatrixXd m = definite(n);
    const PivotedCholesky factor(m);
    const MatrixXd b = matrix(n, 3);
    const VectorXd x = matrix(n, 1);
    expect_near(plain_product(m, factor.solve(b)), b);
    expect_near(plain_product(m, factor.solve(x)), x);
    expect_near(plain_product(m, factor.inverse()), identity(n));
    const MatrixXd root = factor.root(0.0);
    expect_near(square_of(root), m);
  }
  // An undetermined unknown stays 0.
  MatrixXd m = identity(3);
  m(1, 1) = 0.0;
  expect_near(PivotedCholesky(m).solve(VectorXd(VectorXd::Ones(3))),
              Eigen::Vector3d(1.0, 0.0, 1.0));
  m(1, 1) = 0.25;
  expect_near(square_of(PivotedCholesky(m).root(0.5)), Eigen::Vector3d(1.0, 0.0, 1.0).asDiagonal());
}

TEST_F(LinearAlgebra, CovarianceRootSquaredIsTheCovariance) {
  for (const Index n : kSizes) {
    const MatrixXd thin = matrix(n, n / 2);
    const MatrixXd covariance = square_of(thin);
    const MatrixXd root = covariance_root(covariance);
    EXPECT_TRUE(root.allFinite());
    expect_near(square_of(root), covariance);
  }
}

TEST_F(LinearAlgebra, TridiagonalTurnsBackToTheMatrix) {
  for (const Index n : kSizes) {
    SCOPED_TRACE(n);
    const MatrixXd m = definite(n);
    const Tridiagonal turned(m);
    MatrixXd q = identity(n);
    turned.rotate_in_place(q);  // Q'
    expect_near(square_of(q), identity(n));
    MatrixXd j = MatrixXd::Zero(n, n);
    for (Index k = 0; k < n; ++k) {
      j(k, k) = turned.diagonal()[k];
      if (k > 0) j(k, k - 1) = j(k - 1, k) = turned.subdiagonal()[k - 1];
    }
    expect_near(plain_product(q.transpose(), plain_product(j, q)), m);
  }
}

TEST_F(LinearAlgebra, QrColumnsAreOrthonormalAndSpanTheMatrix) {
  for (const Index n : {Index{1}, Index{4}, Index{30}, Index{120}}) {
    for (const Index m : {Index{0}, Index{1}, std::min<Index>(n, 7)}) {
      SCOPED_TRACE(testing::Message() << n << " x " << m);
      const MatrixXd a = matrix(n, m);
      const Qr parts = qr(a);
      expect_near(square_of(parts.q.transpose()), identity(n));
      expect_near(plain_product(parts.q.leftCols(m), parts.r), a);
      expect_near(orthonormal_columns(a), parts.q.leftCols(m));
      expect_near(upper_triangle(a), parts.r);
    }
  }
}

TEST_F(LinearAlgebra, RangeSplitsTheSpaceAtTheRank) {
  const MatrixXd a = plain_product(matrix(12, 3), matrix(3, 5));
  const Range found = range_of(a);
  ASSERT_EQ(found.range.cols(), 3);
  ASSERT_EQ(found.rest.cols(), 9);
  expect_near(plain_product(found.range, plain_product(found.range.transpose(), a)), a);
  expect_near(plain_product(found.rest.transpose(), a), MatrixXd::Zero(9, 5));
  MatrixXd scaled = identity(4);
  scaled(3, 3) = 1e-6;
  EXPECT_EQ(range_of(scaled).range.cols(), 4);
  EXPECT_EQ(range_of(scaled, 1e-4).range.cols(), 3);
}

TEST_F(LinearAlgebra, LeastSquaresResidualIsOrthogonalAndSolutionShortest) {
  const MatrixXd full = matrix(20, 4);
  const MatrixXd flat = plain_product(matrix(20, 2), matrix(2, 4));
  for (const MatrixXd& a : {full, flat}) {
    const VectorXd b = matrix(20, 1);
    const VectorXd x = least_squares(a, b);
    expect_near(plain_product(a.transpose(), b - a * x), MatrixXd::Zero(4, 1));
    // Shortest: no part of it is in A's null space.
    const MatrixXd unseen = range_of(a.transpose()).rest;
    expect_near(plain_product(unseen.transpose(), x), MatrixXd::Zero(unseen.cols(), 1));
    const MatrixXd two = matrix(20, 2);
    expect_near(least_squares(a, two).col(1), least_squares(a, VectorXd(two.col(1))));
  }
}

TEST_F(LinearAlgebra, ThinSvdHasTheEigenvaluesOfTheSquare) {
  for (const Index m : {Index{0}, Index{1}, Index{6}, Index{25}}) {
    SCOPED_TRACE(m);
    const MatrixXd a = matrix(40, m);
    const ThinSvd parts = thin_svd(a);
    expect_near(square_of(parts.u.transpose()), identity(m));
    const MatrixXd scaled = scaled_columns(parts.u, parts.values.cwiseAbs2());
    expect_near(plain_product(scaled, parts.u.transpose()), square_of(a));
  }
}

TEST_F(LinearAlgebra, InverseUndoesTheMatrix) {
  const MatrixXd a = definite(5) + 0.1 * matrix(5, 5);
  expect_near(plain_product(a, inverse(a)), identity(5));
}

/// A matrix whose first number lies so many numbers after a multiple of 32 bytes.
class Placed {
 public:
  Placed(const MatrixXd& m, std::size_t offset)
      : memory_(static_cast<std::size_t>(m.size()) + 8), rows_(m.rows()), columns_(m.cols()) {
    const auto address = reinterpret_cast<std::uintptr_t>(memory_.data()) / sizeof(double);
    data_ = memory_.data() + (4 - address % 4) % 4 + offset;
    map() = m;
  }
  Eigen::Map<MatrixXd> map() { return {data_, rows_, columns_}; }
  kernels::Input input(bool transposed = false) const {
    return {data_, rows_, columns_, rows_, transposed};
  }
  kernels::Output output() const { return {data_, rows_, columns_, rows_}; }
  double* data() const { return data_; }

 private:
  std::vector<double> memory_;
  Index rows_, columns_;
  double* data_ = nullptr;
};

/// A table's results for the same input, concatenated in a column.
VectorXd answers_of(const kernels::Table& table, Index n, std::size_t offset) {
  Draws draws;
  const Placed a(draws.matrix(n, n), offset);
  const MatrixXd columns = draws.matrix(n, 5);
  const Placed b(columns, offset);
  const MatrixXd definite = draws.definite(n);
  std::vector<double> all;
  const auto keep = [&all](Placed& m, bool lower = false) {
    const MatrixXd kept =
        lower ? MatrixXd(m.map().triangularView<Eigen::Lower>()) : MatrixXd(m.map());
    all.insert(all.end(), kept.data(), kept.data() + kept.size());
  };
  for (const bool is_transposed : {false, true}) {
    Placed c(columns, offset);
    table.add_product(c.output(), 0.7, a.input(is_transposed), b.input());
    keep(c);
    Placed one(columns.col(0), offset);
    table.add_product(one.output(), 0.7, a.input(is_transposed),
                      Placed(columns.col(1), offset).input());
    keep(one);
    Placed square(definite, offset);
    table.add_square(square.output(), -0.2, a.input(is_transposed));
    keep(square, true);
  }
  Placed outer(definite, offset);
  table.add_product(outer.output(), 1.0, b.input(), b.input(true));
  keep(outer);
  Placed factor(definite, offset);
  EXPECT_TRUE(table.factorise(factor.output()));
  keep(factor, true);
  for (const bool is_transposed : {false, true}) {
    Placed x(columns, offset);
    table.solve_triangle(factor.input(is_transposed), x.output());
    keep(x);
    Placed one(columns.col(0), offset);
    table.solve_triangle(factor.input(is_transposed), one.output());
    keep(one);
  }
  Placed turned(definite, offset);
  Placed coefficients(VectorXd::Zero(n - 1), offset);
  Placed diagonal(VectorXd::Zero(n), offset);
  Placed subdiagonal(VectorXd::Zero(n - 1), offset);
  table.tridiagonalise(turned.output(), coefficients.data(), diagonal.data(), subdiagonal.data());
  Placed rotated(columns, offset);
  table.rotate(turned.input(), coefficients.data(), rotated.output());
  for (Placed* const one : {&diagonal, &subdiagonal, &rotated}) keep(*one);
  return Eigen::Map<VectorXd>(all.data(), static_cast<Index>(all.size()));
}

constexpr Index kKernelSizes[] = {1, 2, 5, 8, 33, 100, 257};

TEST_F(LinearAlgebra, KernelsAgreeWithTheBaseline) {
  const kernels::Table* const fast = kernels::avx2_here();
  if (fast == nullptr) GTEST_SKIP() << "no AVX2 here";
  for (const Index n : kKernelSizes) {
    SCOPED_TRACE(n);
    const VectorXd slow = answers_of(kernels::baseline, n, 0);
    // 1e-9 is what the answers of a program may differ by from one processor to another.
    EXPECT_LT(largest((answers_of(*fast, n, 0) - slow).array() / slow.array().abs().max(1.0)),
              1e-9);
  }
}

TEST_F(LinearAlgebra, KernelsGiveTheSameBytesWhereverTheNumbersLie) {
  for (const kernels::Table* const table : {&kernels::baseline, kernels::avx2_here()}) {
    if (table == nullptr) continue;
    for (const Index n : kKernelSizes) {
      const VectorXd first = answers_of(*table, n, 0);
      for (const std::size_t offset : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
        EXPECT_EQ((answers_of(*table, n, offset) - first).cwiseAbs().maxCoeff(), 0.0)
            << n << " rows, " << offset << (table == &kernels::baseline ? ", baseline" : ", AVX2");
      }
    }
  }
}

}  // namespace
}  // namespace chaintrue::linear
