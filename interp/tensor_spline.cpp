// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/tensor_spline.hpp"

#include "interp/require.hpp"

namespace chaintrue::interp {
namespace {

// Writes the slopes across two edges; they are zero where none are given.
void set_edges(Eigen::Ref<MatrixXd> edges, const MatrixXd& slopes, const char* axis) {
  if (slopes.size() == 0) return;
  require(slopes.rows() == edges.rows() && slopes.cols() == edges.cols(),
          "{} x {} slopes along {}, where the nodes need {} x {}", slopes.rows(), slopes.cols(),
          axis, edges.rows(), edges.cols());
  require(slopes.allFinite(), "a slope along {} is not finite", axis);
  edges = slopes;
}

}  // namespace

TensorSpline::TensorSpline(std::vector<double> x_nodes, std::vector<double> y_nodes,
                           const Eigen::Ref<const MatrixXd>& values, const TensorEnds& ends,
                           const EdgeSlopes& slopes)
    : TensorSpline(std::make_shared<const TensorAxes>(std::move(x_nodes), std::move(y_nodes), ends),
                   values, slopes) {}

TensorSpline::TensorSpline(std::shared_ptr<const TensorAxes> axes,
                           const Eigen::Ref<const MatrixXd>& values, const EdgeSlopes& slopes)
    : axes_(std::move(axes)) {
  const auto x = axes_->x.nodes();
  const Index nx = std::ssize(x);
  const Index ny = std::ssize(axes_->y);
  require(values.rows() == nx && values.cols() == ny, "{} x {} values for {} x {} nodes",
          values.rows(), values.cols(), nx, ny);
  require(values.allFinite(), "a value of the grid is not finite");
  // The conditions of both axes: values, slopes along the edges, and twists at the corners.
  MatrixXd conditions = MatrixXd::Zero(nx + 2, ny + 2);
  conditions.topLeftCorner(nx, ny) = values;
  set_edges(conditions.bottomLeftCorner(2, ny), slopes.x, "x");
  set_edges(conditions.topRightCorner(nx, 2), slopes.y, "y");
  if (slopes.y.size() > 0) {
    const SplineAxis free_axis({x.begin(), x.end()});
    MatrixXd to_corners(nx, 2);
    to_corners << free_axis.cardinal_weights(x.front()).col(1),
        free_axis.cardinal_weights(x.back()).col(1);
    conditions.bottomRightCorner(2, 2) = to_corners.transpose() * conditions.topRightCorner(nx, 2);
  }
  coefficients_ = axes_->x.solution() * conditions * axes_->y.solution().transpose();
}

ValueGradient TensorSpline::at(double x, double y) const {
  const SplineSupport sx = axes_->x.support(x);
  const SplineSupport sy = axes_->y.support(y);
  ValueGradient result;
  for (Index j = 0; j < sy.count; ++j) {
    double value = 0.0;
    double slope = 0.0;
    for (Index i = 0; i < sx.count; ++i) {
      const double c = coefficients_(sx.first + i, sy.first + j);
      value += c * sx.value[i];
      slope += c * sx.slope[i];
    }
    result.value += value * sy.value[j];
    result.dx += slope * sy.value[j];
    result.dy += value * sy.slope[j];
  }
  return result;
}

Rectangle TensorSpline::domain() const {
  const auto x = axes_->x.nodes();
  const auto y = axes_->y.nodes();
  return {x.front(), x.back(), y.front(), y.back()};
}

MatrixXd TensorSpline::cardinal_weights(double x, double y) const {
  return axes_->x.cardinal_weights(x).col(0) * axes_->y.cardinal_weights(y).col(0).transpose();
}

}  // namespace chaintrue::interp
