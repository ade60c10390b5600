// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Tensor-product spline on two non-uniform axes: bicubic, C2 everywhere, or with not-a-knot ends
/// biquintic, C4, for smooth surfaces measured without noise.
///
/// Exact for every bicubic (biquintic) polynomial where both ends of both axes are not-a-knot.
///
/// Outside the rectangle of the nodes the polynomial of the nearest edge cell continues; at degree
/// five it is accurate for only a fraction of a cell.

#include <memory>
#include <utility>
#include <vector>

#include "interp/eigen.hpp"
#include "interp/spline_axis.hpp"
#include "interp/surface.hpp"

namespace chaintrue::interp {

/// The four edges' end conditions.
struct TensorEnds {
  AxisEnds x;
  AxisEnds y;
};

/// Slopes across clamped edges. An empty matrix means zero slope. At a corner where two clamped
/// edges meet, the twist is the derivative along x of the given edge slopes (not-a-knot).
struct EdgeSlopes {
  MatrixXd x;  ///< df/dx: rows for x_min and x_max, a column for each y node
  MatrixXd y;  ///< df/dy: a row for each x node, columns for y_min and y_max
};

/// Two solved axes, shared by surfaces on the same grid.
struct TensorAxes {
  TensorAxes(std::vector<double> x_nodes, std::vector<double> y_nodes, const TensorEnds& ends = {},
             int degree = 3)
      : x(std::move(x_nodes), ends.x, degree), y(std::move(y_nodes), ends.y, degree) {}
  SplineAxis x;
  SplineAxis y;
};

/// One interpolating surface. Immutable, thread safe, `at` allocates nothing.
///
///     TensorSpline z({0, 400, 800, 1200}, {0, 300, 600, 900}, values);   // values(ix, iy)
///     ValueGradient here = z.at(100.0, 200.0);
class TensorSpline final : public Surface {
 public:
  /// `values(ix, iy)` is the value at (x node ix, y node iy). Throws std::invalid_argument when the
  /// shape does not fit the axes or a value is not finite.
  TensorSpline(std::vector<double> x_nodes, std::vector<double> y_nodes,
               const Eigen::Ref<const MatrixXd>& values, const TensorEnds& ends = {},
               const EdgeSlopes& slopes = {});
  /// On axes that are already solved.
  TensorSpline(std::shared_ptr<const TensorAxes> axes, const Eigen::Ref<const MatrixXd>& values,
               const EdgeSlopes& slopes = {});

  ValueGradient at(double x, double y) const override;
  Rectangle domain() const override;

  const TensorAxes& axes() const { return *axes_; }
  /// Coefficients of the products of the two axes' B-splines, (x, y).
  const MatrixXd& coefficients() const { return coefficients_; }

  /// The surface at (x, y) as weights on the node values, w(ix, iy), which propagate the covariance
  /// of the measured values to any point. Clamped ends count as clamped to zero slope.
  MatrixXd cardinal_weights(double x, double y) const;

 private:
  std::shared_ptr<const TensorAxes> axes_;
  MatrixXd coefficients_;
};

}  // namespace chaintrue::interp
