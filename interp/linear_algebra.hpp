// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Dense matrices: products and decompositions, compiled once. Elsewhere in interp/ and grid/ nothing
/// instantiates Eigen's decompositions of dynamic matrices (tests/layers), and products of such go
/// through these functions, which take the instructions of the processor at hand
/// (linear_algebra_kernels.hpp).
///
///   const linear::Cholesky noise(linear::outer(scaled, 1.0));           // 1 + S S' = L L'
///   noise.half_solve_in_place(design);                                  // L^-1 design
///   const Eigen::MatrixXd normal = linear::one_plus_gram(design);       // 1 + A'A
///   const Eigen::VectorXd right = linear::inner(design, data);
///
/// Arguments may be blocks; those whose columns are contiguous are not copied. Matrices may have no
/// rows or columns. Deterministic: same processor, same bytes, from any number of threads.
#pragma once

#include <memory>

#include "interp/eigen.hpp"

namespace chaintrue::linear {

/// An argument: a matrix or vector, or the transpose of one. Lives as long as what it refers to.
struct Operand {
  template <class Derived>
  Operand(const Eigen::DenseBase<Derived>& m) : stored(m.derived()) {}
  Index rows() const { return is_transposed ? stored.cols() : stored.rows(); }
  Index columns() const { return is_transposed ? stored.rows() : stored.cols(); }

  Eigen::Ref<const MatrixXd> stored;
  bool is_transposed = false;
};
inline Operand transposed(const Operand& a) {
  Operand result = a;
  result.is_transposed = !a.is_transposed;
  return result;
}

template <class B>
concept VectorLike = B::ColsAtCompileTime == 1;
/// A vector for a vector, a matrix for a matrix or an operand.
template <class B>
using Like = Eigen::Matrix<double, Eigen::Dynamic, VectorLike<B> ? 1 : Eigen::Dynamic>;

/// c += scale a b, at most one of them transposed
void add_product(Eigen::Ref<MatrixXd> c, double scale, const Operand& a, const Operand& b);
/// a b
template <class B>
Like<B> product(const Operand& a, const B& b) {
  const Operand right(b);
  Like<B> c = Like<B>::Zero(a.rows(), right.columns());
  add_product(c, 1.0, a, right);
  return c;
}
/// a' b
template <class B>
Like<B> inner(const Operand& a, const B& b) {
  return product(transposed(a), b);
}
/// c += scale A A' for a symmetric c
void add_outer(MatrixXd& c, double scale, const Operand& a);
/// c += scale A'A for a symmetric c
inline void add_gram(MatrixXd& c, double scale, const Operand& a) {
  add_outer(c, scale, transposed(a));
}
/// diagonal + A A'
MatrixXd outer(const Operand& a, double diagonal = 0.0);
/// A'A
inline MatrixXd gram(const Operand& a) { return outer(transposed(a)); }
/// 1 + A'A
inline MatrixXd one_plus_gram(const Operand& a) { return outer(transposed(a), 1.0); }
/// A C A'
inline MatrixXd carried(const Operand& a, const Operand& c) {
  return product(product(a, c), transposed(a));
}
/// A diag(s)
MatrixXd scaled_columns(const Eigen::Ref<const MatrixXd>& a, const Eigen::Ref<const VectorXd>& s);

/// x = L^-1 x of a lower triangle or its transpose
void solve_triangle(const Operand& lower, Eigen::Ref<MatrixXd> x);

/// M = L L' of a symmetric positive definite matrix; only the lower triangle is read.
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(MatrixXd matrix);
  /// False if a pivot was not positive or not a number; then no other member may be called.
  bool is_positive_definite() const { return is_positive_definite_; }
  Index size() const { return lower_.rows(); }

  /// M^-1 b
  template <class B>
  Like<B> solve(const B& b) const {
    Like<B> x = half_solve(b);
    solve_triangle(transposed(lower_), x);
    return x;
  }
  /// L^-1 b
  template <class B>
  Like<B> half_solve(const B& b) const {
    Like<B> x = b;
    half_solve_in_place(x);
    return x;
  }
  void half_solve_in_place(Eigen::Ref<MatrixXd> b) const { solve_triangle(lower_, b); }
  /// M^-1
  MatrixXd inverse() const;
  /// L^-T: a square root of M^-1.
  MatrixXd root_of_inverse() const;
  /// L
  const MatrixXd& lower() const { return lower_; }
  /// log |M|
  double log_det() const;

 private:
  MatrixXd lower_;
  bool is_positive_definite_ = true;
};

/// M = P' L D L' P of a symmetric, possibly semidefinite matrix: for a few unknowns that the data
/// may leave undetermined.
class PivotedCholesky {
 public:
  explicit PivotedCholesky(const MatrixXd& matrix);
  /// M^-1 b; 0 along the null directions of M.
  template <class B>
  Like<B> solve(const B& b) const {
    return solved(b);
  }
  MatrixXd inverse() const;
  /// A square F with F F' = M, its columns zero whose D is at most `least`.
  MatrixXd root(double least) const;

 private:
  MatrixXd solved(const MatrixXd& b) const;

  std::shared_ptr<const Eigen::LDLT<MatrixXd>> factor_;
};

/// M = V diag(values) V' of a symmetric matrix, from its lower triangle; values ascending, the columns
/// of V orthonormal.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(const MatrixXd& matrix);
  const VectorXd& eigenvalues() const { return values_; }
  const MatrixXd& eigenvectors() const { return vectors_; }

 private:
  VectorXd values_;
  MatrixXd vectors_;
};
/// F with F F' = C of a covariance, which may be semidefinite up to rounding; a column for each
/// direction, the widest last.
MatrixXd covariance_root(const MatrixXd& covariance);

/// M = Q J Q' of a symmetric matrix, J with one entry beside each on the diagonal.
class Tridiagonal {
 public:
  Tridiagonal() = default;
  explicit Tridiagonal(MatrixXd matrix);
  const VectorXd& diagonal() const { return diagonal_; }
  const VectorXd& subdiagonal() const { return subdiagonal_; }
  /// x = Q' x
  void rotate_in_place(MatrixXd& x) const;

 private:
  MatrixXd reflections_;
  VectorXd coefficients_, diagonal_, subdiagonal_;
};

/// A = Q R of a matrix with at least as many rows as columns.
struct Qr {
  MatrixXd q;  ///< rows x rows
  MatrixXd r;  ///< columns x columns, an upper triangle
};
Qr qr(const MatrixXd& a);
/// Q's first columns: orthonormal, they span what those of A span.
MatrixXd orthonormal_columns(const MatrixXd& a);
/// R alone: R'R = A'A.
MatrixXd upper_triangle(const MatrixXd& a);

/// Orthonormal columns: those of `range` span the columns of A up to rounding, `rest` their
/// orthogonal complement.
struct Range {
  MatrixXd range;
  MatrixXd rest;
};
/// \param least share of the largest pivot below which a pivot counts as zero; 0: as many roundings
/// as A has columns.
Range range_of(const MatrixXd& a, double least = 0.0);

/// The x of least length for which A x - b is shortest.
MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b);

/// A = U diag(values) W' with as few columns in U as A has rows or columns.
struct ThinSvd {
  MatrixXd u;
  VectorXd values;  ///< descending
};
ThinSvd thin_svd(const MatrixXd& a);

/// A^-1 of any square matrix that has one.
MatrixXd inverse(const MatrixXd& a);

}  // namespace chaintrue::linear
