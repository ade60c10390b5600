// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/observed_subspace.hpp"

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

/// R with R R' the pseudo-inverse of the penalty P. With Pi the projector on the polynomials and
/// P + c Pi = L L', the inverse of L L' is the pseudo-inverse and Pi / c: R = (1 - Pi) L^-T.
MatrixXd bending_root(const MatrixXd& penalty, const MatrixXd& polynomials) {
  const Index size = penalty.rows();
  const MatrixXd orthonormal = linear::orthonormal_columns(polynomials);
  const double scale = penalty.trace() / as_double(size);
  MatrixXd bent = penalty;
  linear::add_outer(bent, scale, orthonormal);
  MatrixXd root = linear::Cholesky(std::move(bent)).root_of_inverse();
  linear::add_product(root, -1.0, orthonormal, linear::inner(orthonormal, root));
  return root;
}

}  // namespace

ObservedSubspace::ObservedSubspace(const interp::BsplineBasis& basis, int bending_order,
                                   const std::vector<MarkPoint>& marks)
    : polynomials(basis.polynomial_coefficients(bending_order - 1)) {
  const auto points = std::ssize(marks);
  const Index size = basis.size();
  const MatrixXd penalty = basis.bending_penalty(bending_order);
  penalty_trace = penalty.trace();
  const MatrixXd root = bending_root(penalty, polynomials);
  MatrixXd rows(points, size);  // phi
  for (const Index i : each_below(points))
    rows.row(i) = basis.row(marks[as_size(i)].x_mm, marks[as_size(i)].y_mm);
  penalised_rows = linear::product(rows, root);
  polynomial_rows = linear::product(rows, polynomials);
  squares = rows.rowwise().squaredNorm();
  if (points >= size) {
    penalised = root;
    null_space.resize(size, 0);
    return;
  }
  // The rows are T' Q': the columns of Q span what the points observe.
  const linear::Qr parts = linear::qr(penalised_rows.transpose());
  const MatrixXd turned = linear::product(root, parts.q);
  penalised = turned.leftCols(points);
  null_space = turned.rightCols(size - points);
  penalised_rows = parts.r.transpose();
}

}  // namespace chaintrue::grid
