// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Tensor-product quintic spline with not-a-knot ends: C4, for smooth surfaces measured without
/// noise.
///
/// An axis of n nodes carries degree 5 from six nodes on, the not-a-knot cubic with four or five,
/// the parabola with three, the straight line with two. Knots: the interior nodes without the
/// (degree - 1) / 2 next to each end (C. de Boor, A Practical Guide to Splines, chapter XIII).
/// Exact for every polynomial of those degrees. Outside, the polynomial of the nearest edge cell
/// continues; at degree five it is accurate for only a fraction of a cell.

#include <vector>

#include <Eigen/Core>

#include "interp/surface.hpp"

namespace chaintrue::interp {

/// Immutable, thread safe, `at` allocates nothing.
class QuinticSpline final : public Surface {
 public:
  /// `values(ix, iy)`; throws std::invalid_argument as TensorSpline does.
  QuinticSpline(const std::vector<double>& x_nodes,
                const std::vector<double>& y_nodes,
                const Eigen::Ref<const Eigen::MatrixXd>& values);

  [[nodiscard]] ValueGradient at(double x, double y) const override;
  [[nodiscard]] Rectangle domain() const override { return domain_; }

  /// One axis of B-splines of one degree; internal.
  struct Axis {
    int degree;
    std::vector<double> knots;  // degree + 1 times each end
    Eigen::Index functions;
  };

 private:
  Rectangle domain_;
  Axis x_;
  Axis y_;
  Eigen::MatrixXd coefficients_;
};

}  // namespace chaintrue::interp
