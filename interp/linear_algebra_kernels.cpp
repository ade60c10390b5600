// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once for each table (tools/cmake/linear_algebra.cmake), CHAINTRUE_KERNELS its name.
// Includes Eigen and the tables' header alone.
#include "interp/linear_algebra_kernels.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace chaintrue::linear::kernels {
namespace {

using Columns = Eigen::OuterStride<>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd, Eigen::Unaligned, Columns>;
using Matrix = Eigen::Map<Eigen::MatrixXd, Eigen::Unaligned, Columns>;
using Vector = Eigen::Map<Eigen::VectorXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

ConstMatrix stored(const Input& a) { return {a.data, a.rows, a.columns, Columns(a.stride)}; }
Matrix stored(const Output& a) { return {a.data, a.rows, a.columns, Columns(a.stride)}; }

/// Below this sum of dimensions packing costs more than it saves.
constexpr std::ptrdiff_t kFew = 20;

/// Addresses the operand, not its storage. Eigen reads such numbers one by one, so that a product of
/// them sums in the same order wherever they lie.
using Entries = Eigen::Map<const Eigen::MatrixXd, Eigen::Unaligned,
                           Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>>;
Entries entries(const Input& a) {
  if (a.transposed) return {a.data, a.columns, a.rows, {1, a.stride}};
  return {a.data, a.rows, a.columns, {a.stride, 1}};
}

/// Eigen's own entry for products that are not small: it scales without a temporary, and takes one
/// column or row as a vector.
template <class Left, class Right>
void add_many(Output c, double scale, const Left& a, const Right& b) {
  Matrix sum = stored(c);
  Eigen::internal::generic_product_impl<Left, Right, Eigen::DenseShape, Eigen::DenseShape,
                                        Eigen::GemmProduct>::scaleAndAddTo(sum, a, b, scale);
}

void add_product(Output c, double scale, Input a, Input b) {
  const Entries left = entries(a);
  if (c.rows + c.columns + left.cols() < kFew) {
    stored(c) += scale * left.lazyProduct(entries(b));
  } else if (a.transposed) {
    add_many(c, scale, stored(a).transpose(), stored(b));
  } else if (b.transposed) {
    add_many(c, scale, stored(a), stored(b).transpose());
  } else {
    add_many(c, scale, stored(a), stored(b));
  }
}

void add_square(Output c, double scale, Input a) {
  const Entries left = entries(a);
  Matrix sum = stored(c);
  if (2 * c.rows + left.cols() < kFew) {
    sum += scale * left.lazyProduct(left.transpose());
  } else if (a.transposed) {
    sum.selfadjointView<Eigen::Lower>().rankUpdate(stored(a).transpose(), scale);
  } else {
    sum.selfadjointView<Eigen::Lower>().rankUpdate(stored(a), scale);
  }
}

bool factorise(Output a) {
  Matrix matrix = stored(a);
  return Eigen::internal::llt_inplace<double, Eigen::Lower>::blocked(matrix) < 0;
}

template <class Unknown>
void solve(const Input& l, Unknown x) {
  if (l.transposed) {
    stored(l).transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  } else {
    stored(l).triangularView<Eigen::Lower>().solveInPlace(x);
  }
}

void solve_triangle(Input l, Output x) {
  if (x.columns == 1) {
    solve(l, Vector(x.data, x.rows));
  } else {
    solve(l, stored(x));
  }
}

/// Works on copies: Eigen's product of a symmetric matrix and a vector sums in an order that
/// depends on the address, and its own memory is aligned to a packet.
void tridiagonalise(Output a, double* reflections, double* diagonal, double* subdiagonal) {
  Eigen::MatrixXd matrix = stored(a);
  Eigen::VectorXd coefficients(a.rows - 1);
  Eigen::internal::tridiagonalization_inplace(matrix, coefficients);
  stored(a) = matrix;
  Vector(reflections, a.rows - 1) = coefficients;
  Vector(diagonal, a.rows) = matrix.diagonal();
  Vector(subdiagonal, a.rows - 1) = matrix.diagonal<-1>();
}

void rotate(Input a, const double* reflections, Output x) {
  const ConstMatrix matrix = stored(a);
  const ConstVector coefficients(reflections, a.rows - 1);
  Matrix rotated = stored(x);
  Eigen::VectorXd work(x.columns);
  Eigen::HouseholderSequence<ConstMatrix, ConstVector>(matrix, coefficients)
      .setLength(a.rows - 1)
      .setShift(1)
      .adjoint()
      .applyThisOnTheLeft(rotated, work);
}

}  // namespace

const Table CHAINTRUE_KERNELS = {add_product,    add_square,     factorise,
                                 solve_triangle, tridiagonalise, rotate};

}  // namespace chaintrue::linear::kernels
