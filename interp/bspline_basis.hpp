// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Uniform cubic B-spline tensor basis over a rectangle, with its bending penalties.
///
/// nx by ny intervals carry (nx + 3)(ny + 3) coefficients, numbered with x fastest: coefficient
/// (ix, iy) is number iy (nx + 3) + ix. The functions are the uniform cubic B-splines on the knots
/// x_min + (k - 3) h, k = 0 .. nx + 6 (C. de Boor, A Practical Guide to Splines, chapter IX; P.
/// Eilers and B. Marx, Statist. Sci. 11 (1996) 89-121 for their use with a penalty). They sum to
/// one.
///
/// Outside the rectangle each axis continues linearly from its edge: the surface is C1 across the
/// edge, and linear in the direction across it.

#include <array>

#include "interp/eigen.hpp"
#include "interp/surface.hpp"

namespace chaintrue::interp {

/// The sixteen functions that do not vanish at a point.
struct BasisSupport {
  std::array<Index, 16> index;
  std::array<double, 16> value;
};

/// The functions along one axis.
struct BsplineAxis {
  double low;
  double step;
  Index columns;  ///< three more than intervals
};

/// Immutable, thread safe; `at` allocates nothing.
///
///     BsplineBasis basis({-1200, 1200, -600, 600}, 8, 4);
///     double z = basis.row(x, y).dot(coefficients);
class BsplineBasis {
 public:
  /// Throws std::invalid_argument unless the rectangle has a finite positive area and nx, ny >= 1.
  BsplineBasis(const Rectangle& rectangle, int nx, int ny);

  Index size() const { return x_.columns * y_.columns; }
  Index columns_x() const { return x_.columns; }
  Index columns_y() const { return y_.columns; }
  const Rectangle& rectangle() const { return rectangle_; }

  BasisSupport at(double x, double y) const;

  /// The functions' values as a dense row of size(): f(x, y) = row . c.
  VectorXd row(double x, double y) const;

  /// Value and gradient of the surface with these coefficients.
  ValueGradient evaluate(const Eigen::Ref<const VectorXd>& coefficients, double x, double y) const;

  /// P with c' P c = integral over the rectangle of the squared derivatives of that order (exact):
  /// 2 is the thin plate's f_xx^2 + 2 f_xy^2 + f_yy^2, 3 is f_xxx^2 + 3 f_xxy^2 + 3 f_xyy^2 +
  /// f_yyy^2. Symmetric, positive semidefinite; its null space is the polynomials of lower degree.
  /// Unit: length^(2 - 2 order). Throws std::invalid_argument for other orders.
  MatrixXd bending_penalty(int order) const;

  /// The coefficients of the polynomials up to a degree of 1 or 2, the null space of the penalties:
  /// columns 1, u, v and, for degree 2, u^2, u v, v^2, with u = (x - x_centre) / half width and v
  /// likewise. Throws std::invalid_argument for other degrees.
  MatrixXd polynomial_coefficients(int degree) const;

 private:
  Rectangle rectangle_;
  BsplineAxis x_, y_;
};

}  // namespace chaintrue::interp
