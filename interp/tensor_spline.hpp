// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Tensor-product bicubic spline on two non-uniform axes, C2 everywhere.
///
/// Notation: f, f_x, f_y, f_xy are the value, the two slopes and the twist at a node; they
/// determine the bicubic of each cell (C. de Boor, Bicubic spline interpolation, J. Math. and Phys.
/// 41 (1962) 212-218). Exact for every bicubic polynomial where both ends of both axes are
/// not-a-knot.
///
/// Outside the rectangle of the nodes the bicubic of the nearest edge cell continues.

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "interp/spline_axis.hpp"
#include "interp/surface.hpp"

namespace chaintrue::interp {

/// The four edges' end conditions.
struct TensorEnds {
  AxisEnds x;
  AxisEnds y;
};

/// Slopes along clamped edges. An empty vector means zero slope. At a corner where two clamped
/// edges meet, the twist is the derivative along x of the given edge slopes (not-a-knot).
struct EdgeSlopes {
  Eigen::VectorXd x_low;   ///< df/dx along x = x_min, one for each y node
  Eigen::VectorXd x_high;  ///< df/dx along x = x_max
  Eigen::VectorXd y_low;   ///< df/dy along y = y_min, one for each x node
  Eigen::VectorXd y_high;  ///< df/dy along y = y_max
};

/// Two factored axes, shared by surfaces on the same grid.
struct TensorAxes {
  TensorAxes(std::vector<double> x_nodes, std::vector<double> y_nodes, const TensorEnds& ends = {})
      : x(std::move(x_nodes), ends.x), y(std::move(y_nodes), ends.y) {}
  SplineAxis x;
  SplineAxis y;
};

/// The data of one node: value, slopes and twist.
struct NodeData {
  double f;
  double fx;
  double fy;
  double fxy;
};

/// One interpolating surface. Immutable, thread safe, `at` allocates nothing.
///
///     TensorSpline z({0, 400, 800, 1200}, {0, 300, 600, 900}, values);   // values(ix, iy)
///     ValueGradient here = z.at(100.0, 200.0);
class TensorSpline final : public Surface {
 public:
  /// `values(ix, iy)` is the value at (x node ix, y node iy). Throws std::invalid_argument when the
  /// shape does not fit the axes or a value is not finite.
  TensorSpline(std::vector<double> x_nodes,
               std::vector<double> y_nodes,
               const Eigen::Ref<const Eigen::MatrixXd>& values,
               const TensorEnds& ends = {},
               const EdgeSlopes& slopes = {});
  /// On axes that are already factored.
  TensorSpline(std::shared_ptr<const TensorAxes> axes,
               const Eigen::Ref<const Eigen::MatrixXd>& values,
               const EdgeSlopes& slopes = {});

  [[nodiscard]] ValueGradient at(double x, double y) const override;
  [[nodiscard]] double value(double x, double y) const;
  [[nodiscard]] Rectangle domain() const override;

  [[nodiscard]] const std::shared_ptr<const TensorAxes>& axes() const { return axes_; }
  [[nodiscard]] const NodeData& node(std::size_t ix, std::size_t iy) const {
    return nodes_[iy * axes_->x.size() + ix];
  }

  /// The surface at (x, y) as weights on the node values, w(ix, iy), which propagate the covariance
  /// of the measured values to any point. Clamped ends count as clamped to zero slope.
  [[nodiscard]] Eigen::MatrixXd cardinal_weights(double x, double y) const;

 private:
  std::shared_ptr<const TensorAxes> axes_;
  std::vector<NodeData> nodes_;  // x fastest
};

}  // namespace chaintrue::interp
