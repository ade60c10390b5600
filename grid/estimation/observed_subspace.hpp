// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of a penalised spline surface that a set of points observes: as many combinations of
/// its coefficients as there are points, however fine the splines are.
///
///   s(q) = phi(q)' c,   c = F a + B u + B2 u2                                               (1)
///   u, u2 ~ N(0, I / lambda)                                                                (2)
///
///   phi  the splines at a mark
///   P    their bending penalty
///   F    the polynomials that P leaves free, F' P = 0
///   B    with B2 alongside, B B' + B2 B2' the pseudo-inverse of P: (2) is the prior
///        exp(-lambda c' P c / 2) on all that is no polynomial
///   B2   phi(q)' B2 = 0 at every point: u2 keeps its prior whatever is measured
///
/// With n points and more coefficients than that, a fit of (a, u) costs n^3 and is the same as one
/// of c. Source: C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006),
/// sections 2.2 and 6.3, for the two views of one prior.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "interp/bspline_basis.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

/// Immutable, thread safe.
class ObservedSubspace {
 public:
  ObservedSubspace(const interp::BsplineBasis& basis,
                   int bending_order,
                   const std::vector<model::MarkPoint>& marks);

  [[nodiscard]] Eigen::Index polynomials() const { return polynomials_.cols(); }
  [[nodiscard]] Eigen::Index penalised() const { return penalised_basis_.cols(); }
  /// phi(q)' F and phi(q)' B, one row for each mark.
  [[nodiscard]] const Eigen::MatrixXd& polynomial_rows() const { return polynomial_rows_; }
  [[nodiscard]] const Eigen::MatrixXd& bend_rows() const { return bend_rows_; }
  /// F and B.
  [[nodiscard]] const Eigen::MatrixXd& polynomial_coefficients() const { return polynomials_; }
  [[nodiscard]] const Eigen::MatrixXd& penalised_basis() const { return penalised_basis_; }
  /// B2, a basis of the null space; no columns where the points observe everything.
  [[nodiscard]] const Eigen::MatrixXd& null_space_coefficients() const { return null_space_; }
  /// Trace of P.
  [[nodiscard]] double penalty_trace() const { return penalty_trace_; }
  /// Sum over the splines of phi(q)^2, for each mark.
  [[nodiscard]] const Eigen::VectorXd& squares() const { return squares_; }

 private:
  Eigen::MatrixXd polynomials_;
  Eigen::MatrixXd penalised_basis_;
  Eigen::MatrixXd null_space_;
  Eigen::MatrixXd polynomial_rows_;
  Eigen::MatrixXd bend_rows_;
  Eigen::VectorXd squares_;
  double penalty_trace_ = 0.0;
};

}  // namespace chaintrue::grid
