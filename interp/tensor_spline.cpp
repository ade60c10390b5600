// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/tensor_spline.hpp"

#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp {
namespace {

// Writes the slopes along one edge; they are zero where none are given.
void set_edge(Eigen::Ref<VectorXd> edge, const VectorXd& slopes, const char* name) {
  if (slopes.size() == 0) return;
  if (slopes.size() != edge.size()) {
    throw std::invalid_argument(
        fmt::format("slopes along the edge {}: {} given, its axis has {} nodes", name,
                    slopes.size(), edge.size()));
  }
  if (!slopes.allFinite()) {
    throw std::invalid_argument(fmt::format("slopes along the edge {} are not finite", name));
  }
  edge = slopes;
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
  const auto nx = std::ssize(axes_->x.nodes());
  const auto ny = std::ssize(axes_->y.nodes());
  if (values.rows() != nx || values.cols() != ny) {
    throw std::invalid_argument(
        fmt::format("{} x {} values for {} x {} nodes", values.rows(), values.cols(), nx, ny));
  }
  if (!values.allFinite()) {
    throw std::invalid_argument("a value of the grid is not finite");
  }
  // The conditions of both axes: values, slopes along the edges, and twists at the corners.
  MatrixXd conditions = MatrixXd::Zero(nx + 2, ny + 2);
  conditions.topLeftCorner(nx, ny) = values;
  MatrixXd along_y = MatrixXd::Zero(ny, 2);
  set_edge(along_y.col(0), slopes.x_low, "x_low");
  set_edge(along_y.col(1), slopes.x_high, "x_high");
  conditions.bottomLeftCorner(2, ny) = along_y.transpose();
  set_edge(conditions.col(ny).head(nx), slopes.y_low, "y_low");
  set_edge(conditions.col(ny + 1).head(nx), slopes.y_high, "y_high");
  if (slopes.y_low.size() + slopes.y_high.size() > 0) {
    const SplineAxis free_axis({axes_->x.nodes().begin(), axes_->x.nodes().end()});
    MatrixXd to_corners(nx, 2);
    to_corners << free_axis.slope_weights(free_axis.nodes().front()),
        free_axis.slope_weights(free_axis.nodes().back());
    conditions.bottomRightCorner(2, 2) = to_corners.transpose() * conditions.topRightCorner(nx, 2);
  }
  const MatrixXd along_x = axes_->x.coefficients(conditions);
  coefficients_ = axes_->y.coefficients(along_x.transpose()).transpose();
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
  return axes_->x.cardinal_weights(x) * axes_->y.cardinal_weights(y).transpose();
}

}  // namespace chaintrue::interp
