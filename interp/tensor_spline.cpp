// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/tensor_spline.hpp"

#include <array>
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

// f_xy along an edge y = const from the given f_y there: its slope along x. At the corners the
// given edge slopes determine it, so a clamped x axis uses a not-a-knot end for it.
Eigen::VectorXd edge_twist(const SplineAxis& x_axis, const Eigen::VectorXd& y_slopes) {
  if (y_slopes.size() == 0) return {};
  const SplineAxis free_axis({x_axis.nodes().begin(), x_axis.nodes().end()});
  const Eigen::VectorXd at_corners = free_axis.slopes(y_slopes);
  return x_axis.slopes(y_slopes, at_corners.head(1), at_corners.tail(1));
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

  const Eigen::MatrixXd fx = x_axis.slopes(values, slopes.x_low, slopes.x_high);
  const Eigen::MatrixXd fy = y_axis.slopes(values.transpose(), slopes.y_low, slopes.y_high);
  const Eigen::MatrixXd fxy = y_axis.slopes(
      fx.transpose(), edge_twist(x_axis, slopes.y_low), edge_twist(x_axis, slopes.y_high));
  for (Eigen::Index iy = 0; iy < values.cols(); ++iy) {
    for (Eigen::Index ix = 0; ix < values.rows(); ++ix)
      nodes_.push_back({values(ix, iy), fx(ix, iy), fy(iy, ix), fxy(iy, ix)});
  }
}

ValueGradient TensorSpline::at(double x, double y) const {
  const std::size_t ix = axes_->x.cell(x);
  const std::size_t iy = axes_->y.cell(y);
  const HermiteWeights wx = axes_->x.weights(ix, x);
  const HermiteWeights dx = axes_->x.derivative_weights(ix, x);
  const HermiteWeights wy = axes_->y.weights(iy, y);
  const HermiteWeights dy = axes_->y.derivative_weights(iy, y);
  // Along x at the two lines of nodes below and above, then along y.
  const auto blend = [](const HermiteWeights& w, double low, double high, double d0, double d1) {
    return w.value_low * low + w.value_high * high + w.slope_low * d0 + w.slope_high * d1;
  };
  std::array<double, 2> f, fy, f_dx, fy_dx;
  for (std::size_t j = 0; j < 2; ++j) {
    const NodeData& a = node(ix, iy + j);
    const NodeData& b = node(ix + 1, iy + j);
    f[j] = blend(wx, a.f, b.f, a.fx, b.fx);
    fy[j] = blend(wx, a.fy, b.fy, a.fxy, b.fxy);
    f_dx[j] = blend(dx, a.f, b.f, a.fx, b.fx);
    fy_dx[j] = blend(dx, a.fy, b.fy, a.fxy, b.fxy);
  }
  return {blend(wy, f[0], f[1], fy[0], fy[1]),
          blend(wy, f_dx[0], f_dx[1], fy_dx[0], fy_dx[1]),
          blend(dy, f[0], f[1], fy[0], fy[1])};
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
