// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Dense matrices: products and decompositions, compiled once. Elsewhere in interp/ and grid/ nothing
/// instantiates Eigen's decompositions of dynamic matrices (tests/layers), and products of such go
/// through these functions, which take the instructions of the processor at hand
/// (linear_algebra_kernels.hpp).
///
///   const linear::Cholesky noise(linear::one_plus_outer(scaled));       // 1 + S S' = L L'
///   noise.half_solve_in_place(design);                                  // L^-1 design
///   const Eigen::MatrixXd normal = linear::one_plus_gram(design);       // 1 + A'A
///   const Eigen::VectorXd right = linear::product(linear::transposed(design), data);
///
/// Arguments may be blocks; those whose columns are contiguous are not copied. Matrices may have no
/// rows or columns. Deterministic: same processor, same bytes, from any number of threads.
#pragma once

#include <Eigen/Core>

namespace chaintrue::linear {

/// An argument: a matrix or, of one column, a vector.
template <int kColumns>
class Operand : public Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, kColumns>> {
 public:
  template <class Derived>
    requires((Derived::ColsAtCompileTime == 1) == (kColumns == 1))
  Operand(const Eigen::DenseBase<Derived>& m)
      : Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, kColumns>>(m.derived()) {}
};
using MatrixArgument = Operand<Eigen::Dynamic>;
using VectorArgument = Operand<1>;

/// Lives as long as what it refers to.
struct Transposed {
  const MatrixArgument& of;
};
[[nodiscard]] inline Transposed transposed(const MatrixArgument& a) { return {a}; }

// Products.
[[nodiscard]] Eigen::MatrixXd product(const MatrixArgument& a, const MatrixArgument& b);
[[nodiscard]] Eigen::MatrixXd product(const MatrixArgument& a, Transposed b);
[[nodiscard]] Eigen::MatrixXd product(Transposed a, const MatrixArgument& b);
[[nodiscard]] Eigen::VectorXd product(const MatrixArgument& a, const VectorArgument& x);
[[nodiscard]] Eigen::VectorXd product(Transposed a, const VectorArgument& x);
/// c += scale a b
void add_product(Eigen::Ref<Eigen::MatrixXd> c, double scale, const MatrixArgument& a, const MatrixArgument& b);
void add_product(Eigen::Ref<Eigen::MatrixXd> c, double scale, const MatrixArgument& a, Transposed b);
void add_product(Eigen::Ref<Eigen::MatrixXd> c, double scale, Transposed a, const MatrixArgument& b);
void add_product(Eigen::Ref<Eigen::VectorXd> y, double scale, const MatrixArgument& a, const VectorArgument& x);
void add_product(Eigen::Ref<Eigen::VectorXd> y, double scale, Transposed a, const VectorArgument& x);
/// A'A
[[nodiscard]] Eigen::MatrixXd gram(const MatrixArgument& a);
/// A A'
[[nodiscard]] Eigen::MatrixXd outer(const MatrixArgument& a);
/// 1 + A'A
[[nodiscard]] Eigen::MatrixXd one_plus_gram(const MatrixArgument& a);
/// 1 + A A'
[[nodiscard]] Eigen::MatrixXd one_plus_outer(const MatrixArgument& a);
/// c += scale A'A, of a symmetric c
void add_gram(Eigen::MatrixXd& c, double scale, const MatrixArgument& a);
/// c += scale A A', of a symmetric c
void add_outer(Eigen::MatrixXd& c, double scale, const MatrixArgument& a);
void add_outer(Eigen::MatrixXd& c, double scale, const VectorArgument& x);
/// A C A'
[[nodiscard]] Eigen::MatrixXd carried(const MatrixArgument& a, const MatrixArgument& c);
/// A diag(s)
[[nodiscard]] Eigen::MatrixXd scaled_columns(const MatrixArgument& a, const VectorArgument& s);

/// M = L L' of a symmetric positive definite matrix; only the lower triangle is read.
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(Eigen::MatrixXd matrix);
  /// False if a pivot was not positive or not a number; then no other member may be called.
  [[nodiscard]] bool is_positive_definite() const { return is_positive_definite_; }
  [[nodiscard]] Eigen::Index size() const { return lower_.rows(); }

  /// M^-1 b
  [[nodiscard]] Eigen::MatrixXd solve(const MatrixArgument& b) const;
  [[nodiscard]] Eigen::VectorXd solve(const VectorArgument& b) const;
  /// L^-1 b
  [[nodiscard]] Eigen::MatrixXd half_solve(const MatrixArgument& b) const;
  [[nodiscard]] Eigen::VectorXd half_solve(const VectorArgument& b) const;
  void half_solve_in_place(Eigen::Ref<Eigen::MatrixXd> b) const;
  /// M^-1
  [[nodiscard]] Eigen::MatrixXd inverse() const;
  /// L^-T: a square root of M^-1.
  [[nodiscard]] Eigen::MatrixXd root_of_inverse() const;
  /// L
  [[nodiscard]] const Eigen::MatrixXd& lower() const { return lower_; }
  /// log |M|
  [[nodiscard]] double log_det() const;

 private:
  Eigen::MatrixXd lower_;
  bool is_positive_definite_ = true;
};

/// M = P' L D L' P of a symmetric, possibly semidefinite matrix: for few unknowns that the data may
/// not determine.
class PivotedCholesky {
 public:
  explicit PivotedCholesky(const Eigen::MatrixXd& matrix);
  /// M^-1 b; 0 along the null directions of M.
  [[nodiscard]] Eigen::MatrixXd solve(const MatrixArgument& b) const;
  [[nodiscard]] Eigen::VectorXd solve(const VectorArgument& b) const;
  [[nodiscard]] Eigen::MatrixXd inverse() const;
  /// F with F F' = M, without the columns whose D is at most `least`.
  [[nodiscard]] Eigen::MatrixXd root(double least) const;

 private:
  Eigen::MatrixXd triangle_;  ///< L below the diagonal, D on it
  Eigen::Transpositions<Eigen::Dynamic> exchanged_;
};

/// M = V diag(values) V' of a symmetric matrix of which the lower triangle is read; values ascending, the columns
/// of V orthonormal.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(const Eigen::MatrixXd& matrix);
  [[nodiscard]] const Eigen::VectorXd& eigenvalues() const { return values_; }
  [[nodiscard]] const Eigen::MatrixXd& eigenvectors() const { return vectors_; }

 private:
  Eigen::VectorXd values_;
  Eigen::MatrixXd vectors_;
};
/// F with F F' = C of a covariance, which may be semidefinite but for rounding; a column for each
/// direction, the widest last.
[[nodiscard]] Eigen::MatrixXd covariance_root(const Eigen::MatrixXd& covariance);

/// M = Q J Q' of a symmetric matrix, J with one entry beside each on the diagonal.
class Tridiagonal {
 public:
  Tridiagonal() = default;
  explicit Tridiagonal(Eigen::MatrixXd matrix);
  [[nodiscard]] const Eigen::VectorXd& diagonal() const { return diagonal_; }
  [[nodiscard]] const Eigen::VectorXd& subdiagonal() const { return subdiagonal_; }
  /// x = Q' x
  void rotate_in_place(Eigen::MatrixXd& x) const;

 private:
  Eigen::MatrixXd reflections_;
  Eigen::VectorXd coefficients_, diagonal_, subdiagonal_;
};

/// A = Q R of a matrix with at least as many rows as columns.
struct Qr {
  Eigen::MatrixXd q;  ///< rows x rows
  Eigen::MatrixXd r;  ///< columns x columns, an upper triangle
};
[[nodiscard]] Qr qr(const Eigen::MatrixXd& a);
/// Q's first columns: orthonormal, they span what those of A span.
[[nodiscard]] Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& a);
/// R alone: R'R = A'A.
[[nodiscard]] Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& a);

/// Orthonormal columns: those of `range` span the columns of A up to rounding, `rest` their
/// orthogonal complement.
struct Range {
  Eigen::MatrixXd range;
  Eigen::MatrixXd rest;
};
/// \param least share of the largest pivot below which a pivot counts as zero; 0: as many roundings
/// as A has columns.
[[nodiscard]] Range range_of(const Eigen::MatrixXd& a, double least = 0.0);

/// The x of least length for which A x - b is shortest.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const MatrixArgument& b);
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const VectorArgument& b);

/// A = U diag(values) W' with as few columns in U as A has rows or columns.
struct ThinSvd {
  Eigen::MatrixXd u;
  Eigen::VectorXd values;  ///< descending
};
[[nodiscard]] ThinSvd thin_svd(const Eigen::MatrixXd& a);

/// A^-1 of any square matrix that has one.
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

}  // namespace chaintrue::linear
