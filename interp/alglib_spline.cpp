// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/alglib_spline.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <libalglib/interpolation.h>

#include "interp/spline_axis.hpp"

namespace chaintrue::interp {

struct AlglibSpline::Interpolant {
  alglib::spline2dinterpolant spline;
};

AlglibSpline::AlglibSpline(const std::vector<double>& x_nodes,
                           const std::vector<double>& y_nodes,
                           const Eigen::Ref<const Eigen::MatrixXd>& values) {
  const SplineAxis x_axis(x_nodes);  // throws where the nodes are no axis
  const SplineAxis y_axis(y_nodes);
  const auto nx = static_cast<Eigen::Index>(x_nodes.size());
  const auto ny = static_cast<Eigen::Index>(y_nodes.size());
  if (values.rows() != nx || values.cols() != ny) {
    throw std::invalid_argument(
        fmt::format("{} x {} values for {} x {} nodes", values.rows(), values.cols(), nx, ny));
  }
  if (!values.allFinite()) {
    throw std::invalid_argument("a value of the grid is not finite");
  }
  domain_ = {x_nodes.front(), x_nodes.back(), y_nodes.front(), y_nodes.back()};
  const Eigen::MatrixXd column_major = values;  // x fastest, as in ALGLIB
  alglib::real_1d_array x;
  alglib::real_1d_array y;
  alglib::real_1d_array f;
  x.setcontent(nx, x_nodes.data());
  y.setcontent(ny, y_nodes.data());
  f.setcontent(nx * ny, column_major.data());
  auto interpolant = std::make_shared<Interpolant>();
  alglib::spline2dbuildbicubicv(x, nx, y, ny, f, 1, interpolant->spline);
  interpolant_ = std::move(interpolant);
}

ValueGradient AlglibSpline::at(double x, double y) const {
  ValueGradient result;
  double twist = 0.0;
  alglib::spline2ddiff(interpolant_->spline, x, y, result.value, result.dx, result.dy, twist);
  return result;
}

}  // namespace chaintrue::interp
