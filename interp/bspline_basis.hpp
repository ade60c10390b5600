// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Uniform cubic B-spline tensor basis over a rectangle, with its thin-plate penalty.
///
/// nx by ny intervals carry (nx + 3)(ny + 3) coefficients, numbered with x fastest: coefficient
/// (ix, iy) is number iy (nx + 3) + ix. The functions are the uniform cubic B-splines on the knots
/// x_min + (k - 3) h, k = 0 .. nx + 6 (C. de Boor, A Practical Guide to Splines, chapter IX; P.
/// Eilers and B. Marx, Statist. Sci. 11 (1996) 89-121 for their use with a penalty). They sum to
/// one.
///
/// Outside the rectangle each axis continues linearly from its edge: the surface stays C1 across
/// the edge, and is a polynomial of degree one in the direction of leaving.

#include <array>

#include <Eigen/Core>

#include "interp/surface.hpp"

namespace chaintrue::interp {

/// The sixteen functions that do not vanish at a point.
struct BasisSupport {
  std::array<Eigen::Index, 16> index;
  std::array<double, 16> value;
  std::array<double, 16> dx;
  std::array<double, 16> dy;
};

/// Immutable, thread safe; `at` allocates nothing.
///
///     BsplineBasis basis({-1200, 1200, -600, 600}, 8, 4);
///     double z = basis.row(x, y).dot(coefficients);
class BsplineBasis {
 public:
  /// Throws std::invalid_argument unless the rectangle has a finite positive area and nx, ny >= 1.
  BsplineBasis(const Rectangle& rectangle, int nx, int ny);

  [[nodiscard]] Eigen::Index size() const { return columns_x_ * columns_y_; }
  [[nodiscard]] Eigen::Index columns_x() const { return columns_x_; }
  [[nodiscard]] Eigen::Index columns_y() const { return columns_y_; }
  [[nodiscard]] const Rectangle& rectangle() const { return rectangle_; }

  [[nodiscard]] BasisSupport at(double x, double y) const;

  /// The same as dense rows of size(): f(x, y) = row . c, df/dx = row_dx . c, df/dy = row_dy . c.
  [[nodiscard]] Eigen::VectorXd row(double x, double y) const;
  [[nodiscard]] Eigen::VectorXd row_dx(double x, double y) const;
  [[nodiscard]] Eigen::VectorXd row_dy(double x, double y) const;

  /// Value and gradient of the surface with these coefficients.
  [[nodiscard]] ValueGradient evaluate(const Eigen::Ref<const Eigen::VectorXd>& coefficients,
                                       double x,
                                       double y) const;

  /// P with c' P c = integral over the rectangle of f_xx^2 + 2 f_xy^2 + f_yy^2 (exact). Symmetric,
  /// positive semidefinite; its null space are the planes, so its rank is size() - 3. Unit:
  /// 1/length^2.
  [[nodiscard]] Eigen::MatrixXd thin_plate_penalty() const;
  [[nodiscard]] Eigen::Index thin_plate_rank() const { return size() - 3; }

  /// The coefficients (size() x 3) of the planes 1, (x - x_centre) / half width, (y - y_centre) /
  /// half height: the null space of the penalty.
  [[nodiscard]] Eigen::MatrixXd plane_coefficients() const;

 private:
  Rectangle rectangle_;
  Eigen::Index columns_x_;
  Eigen::Index columns_y_;
  double step_x_;
  double step_y_;
};

}  // namespace chaintrue::interp
