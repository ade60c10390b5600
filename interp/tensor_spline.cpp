// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/tensor_spline.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp {
namespace {

void check_edge(const Eigen::VectorXd& slopes, std::size_t expected, const char* edge) {
  const auto given = static_cast<std::size_t>(slopes.size());
  if (given != 0 && given != expected) {
    throw std::invalid_argument(fmt::format(
        "slopes along the edge {}: {} given, its axis has {} nodes", edge, given, expected));
  }
  if (!slopes.allFinite()) {
    throw std::invalid_argument(fmt::format("slopes along the edge {} are not finite", edge));
  }
}

const double* data_or_null(const Eigen::VectorXd& v) { return v.size() == 0 ? nullptr : v.data(); }

// f_xy along an edge y = const from the given f_y there: its slope along x. At the corners the
// given edge slopes determine it, so a clamped x axis uses a not-a-knot end for it.
Eigen::VectorXd edge_twist(const SplineAxis& x_axis, const Eigen::VectorXd& y_slopes) {
  if (y_slopes.size() == 0) {
    return {};
  }
  Eigen::VectorXd twist(y_slopes.size());
  const AxisEnds ends = x_axis.ends();
  double low = 0.0;
  double high = 0.0;
  if (ends.low == EndCondition::clamped || ends.high == EndCondition::clamped) {
    const SplineAxis free_axis({x_axis.nodes().begin(), x_axis.nodes().end()}, {});
    free_axis.slopes(y_slopes.data(), twist.data(), {});
    low = twist(0);
    high = twist(twist.size() - 1);
  }
  x_axis.slopes(y_slopes.data(), twist.data(), {}, &low, &high);
  return twist;
}

}  // namespace

TensorSpline::TensorSpline(std::vector<double> x_nodes,
                           std::vector<double> y_nodes,
                           const Eigen::Ref<const Eigen::MatrixXd>& values,
                           const TensorEnds& ends,
                           const EdgeSlopes& slopes)
    : TensorSpline(std::make_shared<const TensorAxes>(std::move(x_nodes), std::move(y_nodes), ends),
                   values,
                   slopes) {}

TensorSpline::TensorSpline(std::shared_ptr<const TensorAxes> axes,
                           const Eigen::Ref<const Eigen::MatrixXd>& values,
                           const EdgeSlopes& slopes)
    : axes_(std::move(axes)) {
  const SplineAxis& x_axis = axes_->x;
  const SplineAxis& y_axis = axes_->y;
  const std::size_t nx = x_axis.size();
  const std::size_t ny = y_axis.size();
  if (static_cast<std::size_t>(values.rows()) != nx ||
      static_cast<std::size_t>(values.cols()) != ny) {
    throw std::invalid_argument(
        fmt::format("{} x {} values for {} x {} nodes", values.rows(), values.cols(), nx, ny));
  }
  if (!values.allFinite()) {
    throw std::invalid_argument("a value of the grid is not finite");
  }
  check_edge(slopes.x_low, ny, "x_low");
  check_edge(slopes.x_high, ny, "x_high");
  check_edge(slopes.y_low, nx, "y_low");
  check_edge(slopes.y_high, nx, "y_high");

  nodes_.resize(nx * ny);
  for (std::size_t iy = 0; iy < ny; ++iy) {
    for (std::size_t ix = 0; ix < nx; ++ix) {
      nodes_[iy * nx + ix].f = values(static_cast<Eigen::Index>(ix), static_cast<Eigen::Index>(iy));
    }
  }
  // The four numbers of a node are adjacent: a step along x is one node, along y one row of nodes.
  constexpr std::ptrdiff_t kNode = sizeof(NodeData) / sizeof(double);
  const auto row = static_cast<std::ptrdiff_t>(nx) * kNode;
  const LineLayout along_x{ny, kNode, row};
  const LineLayout along_y{nx, row, kNode};
  x_axis.slopes(&nodes_[0].f,
                &nodes_[0].fx,
                along_x,
                data_or_null(slopes.x_low),
                data_or_null(slopes.x_high));
  y_axis.slopes(&nodes_[0].f,
                &nodes_[0].fy,
                along_y,
                data_or_null(slopes.y_low),
                data_or_null(slopes.y_high));
  const Eigen::VectorXd twist_low = edge_twist(x_axis, slopes.y_low);
  const Eigen::VectorXd twist_high = edge_twist(x_axis, slopes.y_high);
  y_axis.slopes(
      &nodes_[0].fx, &nodes_[0].fxy, along_y, data_or_null(twist_low), data_or_null(twist_high));
}

ValueGradient TensorSpline::at(double x, double y) const {
  const std::size_t ix = axes_->x.cell(x);
  const std::size_t iy = axes_->y.cell(y);
  const HermiteWeights wx = axes_->x.weights(ix, x);
  const HermiteWeights dx = axes_->x.derivative_weights(ix, x);
  const HermiteWeights wy = axes_->y.weights(iy, y);
  const HermiteWeights dy = axes_->y.derivative_weights(iy, y);
  ValueGradient result;
  for (std::size_t j = 0; j < 2; ++j) {
    const NodeData& a = node(ix, iy + j);
    const NodeData& b = node(ix + 1, iy + j);
    const double f =
        wx.value_low * a.f + wx.value_high * b.f + wx.slope_low * a.fx + wx.slope_high * b.fx;
    const double fy =
        wx.value_low * a.fy + wx.value_high * b.fy + wx.slope_low * a.fxy + wx.slope_high * b.fxy;
    const double f_dx =
        dx.value_low * a.f + dx.value_high * b.f + dx.slope_low * a.fx + dx.slope_high * b.fx;
    const double fy_dx =
        dx.value_low * a.fy + dx.value_high * b.fy + dx.slope_low * a.fxy + dx.slope_high * b.fxy;
    const double value_weight = j == 0 ? wy.value_low : wy.value_high;
    const double slope_weight = j == 0 ? wy.slope_low : wy.slope_high;
    result.value += value_weight * f + slope_weight * fy;
    result.dx += value_weight * f_dx + slope_weight * fy_dx;
    result.dy +=
        (j == 0 ? dy.value_low : dy.value_high) * f + (j == 0 ? dy.slope_low : dy.slope_high) * fy;
  }
  return result;
}

double TensorSpline::value(double x, double y) const { return at(x, y).value; }

Rectangle TensorSpline::domain() const {
  const auto x = axes_->x.nodes();
  const auto y = axes_->y.nodes();
  return {x.front(), x.back(), y.front(), y.back()};
}

Eigen::MatrixXd TensorSpline::cardinal_weights(double x, double y) const {
  return axes_->x.cardinal_weights(x) * axes_->y.cardinal_weights(y).transpose();
}

}  // namespace chaintrue::interp
