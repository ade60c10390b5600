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

#include <vector>

#include "interp/bspline_basis.hpp"
#include "interp/eigen.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

struct ObservedSubspace {
  ObservedSubspace(const interp::BsplineBasis& basis, int bending_order,
                   const std::vector<MarkPoint>& marks);

  MatrixXd polynomials;        ///< F
  MatrixXd penalised;          ///< B
  MatrixXd null_space;         ///< B2; no columns where the points observe everything
  MatrixXd polynomial_rows;    ///< phi(q)' F, one row for each mark
  MatrixXd penalised_rows;     ///< phi(q)' B
  VectorXd squares;            ///< sum over the splines of phi(q)^2, for each mark
  double penalty_trace = 0.0;  ///< of P
};

}  // namespace chaintrue::grid
